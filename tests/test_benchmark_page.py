from tests.benchmarks.page import PAGE, page


def test_the_page_of_benchmarks_is_that_of_the_kept_tables():
    assert PAGE.read_text(encoding="utf-8") == page()

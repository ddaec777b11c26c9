import os
from pathlib import Path

import pytest

from discover.batch.campaigns import listed_campaigns, stamp


@pytest.fixture
def fleet(tmp_path):
    for name in ("north/a", "north/b", "south/a"):
        folder = tmp_path / name
        folder.mkdir(parents=True)
        (folder / "campaign.toml").write_text("title = 'x'\n")
        (folder / "r.csv").write_text("1\n")
    return tmp_path


def labels(*given):
    return [one.label for one in listed_campaigns([Path(g) for g in given])]


def test_a_folder_stands_for_the_campaigns_in_it_in_the_order_of_their_names(fleet):
    assert labels(fleet / "north") == ["a", "b"]


def test_campaigns_of_one_name_have_the_folder_above_in_their_labels(fleet):
    assert labels(fleet / "north", fleet / "south") == ["north-a", "b", "south-a"]


def test_a_label_never_stands_twice(fleet):
    for extra in ("x/north/a", "y/north/a", "north-a"):
        (fleet / extra).mkdir(parents=True)
        (fleet / extra / "campaign.toml").write_text("title = 'x'\n")
    given = [fleet / "x/north/a", fleet / "y/north/a", fleet / "north/a", fleet / "north-a"]
    found = labels(*given)
    assert len(set(found)) == 4
    assert found == labels(*given)


def test_a_campaign_given_twice_is_there_once(fleet, monkeypatch):
    monkeypatch.chdir(fleet / "north")
    assert labels(fleet / "north", "a", "b/campaign.toml") == ["a", "b"]


def test_what_is_not_there_is_kept_to_be_told_later(fleet):
    (one,) = listed_campaigns([fleet / "nowhere"])
    assert one.label == "nowhere"


def test_a_stamp_changes_with_the_files_and_with_what_is_asked(fleet):
    (one,) = listed_campaigns([fleet / "north" / "a"])
    first = stamp(one, {"seed": 0})
    assert stamp(one, {"seed": 0}) == first
    assert stamp(one, {"seed": 1}) != first
    record = one.path / "r.csv"
    state = record.stat()
    record.write_text("2\n")
    os.utime(record, ns=(state.st_atime_ns, state.st_mtime_ns + 1))
    assert stamp(one, {"seed": 0}) != first

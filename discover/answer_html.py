"""An answer as a notebook shows it: its sentences, and a table below."""

from __future__ import annotations

from collections.abc import Sequence

from markupsafe import Markup

from discover.words import named_line

_ROW = Markup(
    '<tr><td style="text-align:left;font-weight:600;vertical-align:top">{}</td>'
    '<td style="text-align:left">{}</td></tr>'
)


def answer_html(
    title: str, lines: Sequence[str], header: Sequence[str], rows: Sequence[Sequence[str]]
) -> str:
    """Return HTML for a notebook's cell.

    Parameters
    ----------
    title : str
        The campaign's.
    lines : sequence of str
        The answer's sentences, each led by its name.
    header : sequence of str
        Of the table.
    rows : sequence of sequence of str
        The table's cells.

    Examples
    --------
    >>> answer_html("a < b", ["Verdict: done"], ["term"], [["inertance"]]).count("&lt;")
    1
    """
    said = Markup("").join(_ROW.format(*named_line(line)) for line in lines)
    heads = Markup("").join(Markup("<th>{}</th>").format(h) for h in header)
    cells = Markup("").join(
        Markup("<tr>{}</tr>").format(Markup("").join(Markup("<td>{}</td>").format(c) for c in row))
        for row in rows
    )
    table = Markup("<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>").format(
        heads, cells
    )
    return str(
        Markup("<div><strong>{}</strong><table>{}</table>{}</div>").format(title, said, table)
    )

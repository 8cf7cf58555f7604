"""Write the LALR tables of the grammars beside them, so that commands need not make them at each start.

Run ``python tools/grammar_tables.py`` after a change of ``layout.lark``, ``english.lark`` or the version of lark; a
test fails otherwise.
"""

from __future__ import annotations

from deixis.grammar.english.parse import ENGLISH
from deixis.grammar.layout.language import LAYOUT


def main() -> None:
    """Write the tables."""
    for grammar in (LAYOUT, ENGLISH):
        grammar.table_file.write_text(grammar.table(), encoding="utf-8")
        print(f"Wrote {grammar.table_file.name}.")


if __name__ == "__main__":
    main()

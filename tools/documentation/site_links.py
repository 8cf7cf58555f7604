"""Check the links of the built site: ``python tools/documentation/site_links.py docs/_build/html``.

Each link to a page, picture or download of the site must lead to a file, and each ``#fragment`` to an element. Links to
other sites are not followed.
"""

from __future__ import annotations

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Collect the links and the identifiers of an HTML page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.names: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Record the identifiers and the links of an element."""
        found = dict(attrs)
        self.names.update(name for name in (found.get("id"), found.get("name")) if name)
        self.links += [link for link in (found.get("href"), found.get("src")) if link]


@cache
def read_page(path: Path) -> Page:
    """Return an HTML file as a page; it is read once."""
    return Page(path.read_text(encoding="utf-8"))


def broken_links(site: Path) -> list[str]:
    """Return one line for each link within a site that leads nowhere, sorted.

    Parameters
    ----------
    site
        The folder of the built site.
    """
    broken = set()
    for path in site.rglob("*.html"):
        for link in read_page(path).links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path.parent / unquote(parts.path) if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                broken.add(f"{path.relative_to(site)}: {link}: there is no such file")
            elif parts.fragment and target.suffix == ".html" and unquote(parts.fragment) not in read_page(target).names:
                broken.add(f"{path.relative_to(site)}: {link}: there is no such place on the page")
    return sorted(broken)


def main() -> None:
    """Print the broken links of the site named on the command line; exit 1 if there is one."""
    site = Path(sys.argv[1])
    broken = broken_links(site)
    print("\n".join(broken) or f"all links within {site} lead somewhere")
    sys.exit(bool(broken))


if __name__ == "__main__":
    main()

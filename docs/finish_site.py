#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finishes the site that Doxygen made, and checks its links.

Doxygen knows neither headings of other pages nor files that are no pages: links to them are led to
the heading, or to a copy of the file. Then every link within the site must lead somewhere.
Usage: finish_site.py SOURCES HTML
"""

import html
import pathlib
import re
import shutil
import sys
import urllib.parse

LINK = re.compile(r'(href|src)="([^"]+)"')
HEADING = re.compile(r'<a class="anchor" id="([^"]+)"></a>\s*(.*?)</h[1-6]>', re.S)


def slug(heading):
    """How GitHub names a heading."""
    text = html.unescape(re.sub(r"<[^>]*>", "", heading)).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


class Site:
    def __init__(self, sources, folder):
        self.sources = sources
        self.folder = folder
        self.texts = {page.name: page.read_text(encoding="utf-8", errors="replace")
                      for page in sorted(folder.glob("*.html"))
                      if not page.name.endswith("_source.html")}
        # Of which file of the project a page was made.
        self.origins = {self.page_of(path): path for path in sources.glob("*.md")}
        for path in [*sources.glob("*/*.md"), *sources.glob("*/*/README.md"),
                     *sources.glob("*/*/*/README.md")]:
            self.origins.setdefault(self.page_of(path), path)

    def page_of(self, path):
        relative = path.resolve().relative_to(self.sources.resolve())
        if str(relative) == "README.md":
            return "index.html"
        return "md_" + "_".join(relative.with_suffix("").parts).replace("-", "_") + ".html"

    def target_of(self, page, link):
        """Where a link to a file of the project leads in the site; None if it is no such link."""
        address = urllib.parse.urlsplit(link)
        if address.scheme or not address.path or (self.folder / address.path).exists():
            return None
        origin = self.origins.get(page, self.sources / "README.md")
        file = (origin.parent / urllib.parse.unquote(address.path)).resolve()
        if not file.is_relative_to(self.sources.resolve()) or not file.is_file():
            return None
        if file.suffix != ".md":
            copy = self.folder / file.relative_to(self.sources.resolve())
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(file, copy)
            return str(copy.relative_to(self.folder))
        made = self.page_of(file)
        if made not in self.texts:
            return None
        anchors = {slug(text): name for name, text in HEADING.findall(self.texts[made])}
        return made + ("#" + anchors[address.fragment] if address.fragment in anchors else
                       "#" + address.fragment if address.fragment else "")

    def finish(self):
        for page, text in self.texts.items():
            def led(match, page=page):
                target = self.target_of(page, html.unescape(match.group(2)))
                return f'{match.group(1)}="{target}"' if target else match.group(0)
            finished = LINK.sub(led, text)
            if finished != text:
                (self.folder / page).write_text(finished, encoding="utf-8")
                self.texts[page] = finished

    def broken(self):
        names = {page: set(re.findall(r'(?:id|name)="([^"]+)"', text))
                 for page, text in self.texts.items()}
        for page, text in self.texts.items():
            for _, link in LINK.findall(text):
                address = urllib.parse.urlsplit(html.unescape(link))
                if address.scheme or link.startswith("//"):
                    continue
                path = urllib.parse.unquote(address.path) or page
                fragment = urllib.parse.unquote(address.fragment)
                if not (self.folder / path).is_file():
                    yield page, link
                elif fragment and path in names and fragment not in names[path]:
                    yield page, link


def main():
    site = Site(*map(pathlib.Path, sys.argv[1:]))
    site.finish()
    broken = sorted(set(site.broken()))
    for page, link in broken:
        print(f"{page}: {link} leads nowhere", file=sys.stderr)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())

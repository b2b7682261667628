#!/usr/bin/env python3
"""mdBook preprocessor: formulas become MathML, which browsers draw without script, font or network.

Formulas are written so that web views of the repository draw them too: `$…$` within a line, a
fenced block `math` on its own. A comment `<!-- age -->` becomes the table of `age.py`.
"""

import json
import re
import sys
from pathlib import Path

# Fenced blocks, code within a line, formulas within a line: whichever begins first has its way, so
# that a dollar in code stays what it is. A formula neither begins nor ends with a space.
PARTS = re.compile(
    r"^(?P<indent> *)(?P<fence>```+|~~~+)(?P<info>[^\n]*)\n(?P<block>.*?)^ *(?P=fence)[^\n]*$"
    r"|(?P<ticks>`+)(?P<code>.+?)(?P=ticks)"
    r"|(?<![\\$\w])\$(?P<formula>[^\s$](?:[^$\n]|\n(?!\n))*?(?<![\s\\]))\$(?![\w$])",
    re.MULTILINE | re.DOTALL,
)

# What Markdown would read as its own between the tags.
MARKDOWN = {ord(c): f"&#{ord(c)};" for c in "*_`|[]\\~"}


class Formulas:
    def __init__(self):
        from math_core import LatexToMathML

        # An unknown command is an error: a formula in red is no formula.
        self.converter = LatexToMathML(continue_on_error=False, ignore_unknown_commands=False)

    def mathml(self, latex, display):
        text = self.converter.convert_with_local_state(latex.strip(), displaystyle=display)
        text = re.sub(r"\s*\n\s*", " ", text)
        # Tags as they are, text between them in Markdown's terms.
        return re.sub(r"(<[^>]*>)|([^<]+)", lambda m: m[1] or m[2].translate(MARKDOWN), text)

    def page(self, markdown, name):
        def part(found):
            try:
                if found["fence"] and found["info"].strip() == "math":
                    block = re.sub(r"^" + found["indent"], "", found["block"], flags=re.MULTILINE)
                    return f'{found["indent"]}<p class="formula">{self.mathml(block, True)}</p>'
                if found["formula"]:
                    return self.mathml(found["formula"], False)
            except Exception as error:
                sys.exit(f"{name}: {found[0].strip()}\n  is no formula: {error}")
            return found[0]

        return PARTS.sub(part, markdown)


def out_of_the_book(markdown, source):
    """Links to Markdown files that are no pages: mdBook would make them `.html`, which are not there.

    `source` is the page's path below `src`. Written as `%2Emd` the name stays as it is, and a browser
    finds the file.
    """
    src = Path(__file__).resolve().parent.parent / "src"

    def link(found):
        leads_out = not ((src / source).parent / f"{found[1]}.md").resolve().is_relative_to(src)
        return f"]({found[1]}%2Emd{found[2]})" if leads_out else found[0]

    return re.sub(r"\]\(([^)\s:#]+)\.md((?:#[^)\s]*)?)\)", link, markdown)


def chapters(items):
    for item in items:
        chapter = item.get("Chapter") if isinstance(item, dict) else None
        if chapter:
            yield chapter
            yield from chapters(chapter["sub_items"])


def main():
    if sys.argv[1:2] == ["supports"]:
        sys.exit(0 if sys.argv[2] == "html" else 1)
    _, book = json.load(sys.stdin)
    import age

    formulas = Formulas()
    for chapter in chapters(book.get("items") or book.get("sections")):
        text = chapter["content"]
        if "<!-- age -->" in text:
            text = text.replace("<!-- age -->", age.markdown(age.ages()))
        text = out_of_the_book(text, chapter["path"])
        chapter["content"] = formulas.page(text, chapter["path"])
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()

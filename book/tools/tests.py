#!/usr/bin/env python3
"""That the book's checks find what they are for: python3 book/tools/tests.py"""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import age
import links
import mathematics
import quickstart
import quotes


def write(root, name, text):
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


class Links(unittest.TestCase):
    def faults(self, **pages):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            write(root, "README.md", "# House\n\n[in](book/src/a.md#two-words)\n")
            write(root, "book/src/SUMMARY.md", "- [A](a.md)\n")
            write(root, "book/src/a.md", "# A\n\n## Two *words*\n\n" + pages.pop("a", ""))
            for name, text in pages.items():
                write(root, f"book/src/{name}.md", text)
            return [f.split(": ", 1)[1] for f in links.faults(root) if ": " in f] + [
                f for f in links.faults(root) if ": " not in f
            ]

    def test_whole_pages_are_in_order(self):
        text = "[x](#a) [y](../../README.md#house) `[z](none.md)` [web](https://example.org)\n"
        self.assertEqual(self.faults(a=text + "\n```text\n[code](none.md)\n```\n"), [])

    def test_a_missing_file_a_missing_heading_and_a_missing_picture(self):
        found = self.faults(a="[x](b.md) [y](#three) ![z](c.png) <img src='d' src=\"d.png\">\n")
        self.assertEqual(len(found), 4)
        self.assertIn("b.md: b.md does not exist", found)
        self.assertIn("#three: a.md has no heading #three", found)

    def test_what_is_included_must_be_there(self):
        found = self.faults(a="```text\n{{#include ../../scene.toml}}\n```\n")
        self.assertEqual(len(found), 1)

    def test_every_page_is_in_the_summary(self):
        self.assertEqual(self.faults(lost="# Lost\n"), ["book/src/lost.md is not in SUMMARY.md"])

    def test_a_built_book(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            write(root, "target/book/index.html", '<h1 id="a"><a href="#a">A</a><a href="b.html">')
            found = list(links.faults(root, root / "target/book"))
            self.assertEqual(found, ["target/book/index.html:1: b.html: b.html does not exist"])


class QuickStart(unittest.TestCase):
    def test_commands_are_those_of_bash_blocks(self):
        page = "# Q\n\n## One\n\n```bash\na\nb\n```\n\n```text\nno\n```\n\n## Two\n\n```bash\nc\n```\n"
        script = quickstart.script(page)
        self.assertTrue(script.endswith("\n# One\na\nb\n\n# Two\nc\n"))
        self.assertNotIn("no\n", script.removeprefix(quickstart.HEAD))


class Quotes(unittest.TestCase):
    def test_what_no_scene_says_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder).resolve()
            write(root, "examples/case/scene.toml", "version = 1\n\n[mesh]\nfile = \"a.msh\"\n")
            page = root / "book/src/tutorials/case.md"
            write(root, page, "# C\n\n```toml\n[mesh]\nfile = \"a.msh\"\n```\n")
            self.assertEqual(list(quotes.faults(root)), [])
            write(root, page, "# C\n\n```toml\nversion = 1\n\n[mesh]\nfile = \"b.msh\"\n```\n")
            self.assertEqual(len(list(quotes.faults(root))), 1)


class Ages(unittest.TestCase):
    """A repository of three commits: code, results, code again."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name).resolve()
        self.git("init", "-q")
        chapter = "# V\n\n## col\n\n*Column.* Source:\n`validation/src/cases/col.rs`.\n"
        write(self.root, "book/src/validation.md", chapter)
        write(self.root, "crates/moldwarp/src/lib.rs", "1")
        write(self.root, "validation/src/cases/col.rs", "1")
        self.commit("code")
        write(self.root, "validation/results/fine/col.csv", "1")
        self.commit("results")

    def tearDown(self):
        self.folder.cleanup()

    def git(self, *arguments):
        who = ["-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false"]
        command = ["git", *who, *arguments]
        return subprocess.run(command, cwd=self.root, check=True, capture_output=True, text=True)

    def commit(self, message):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", message)
        return self.git("rev-parse", "--short=7", "HEAD").stdout.strip()

    def verdict(self):
        (row,) = age.ages(self.root)
        return age.verdict(row)

    def test_results_are_young_until_solver_or_case_change(self):
        self.assertEqual(self.verdict(), "no")
        write(self.root, "README.md", "1")
        self.commit("text")
        self.assertEqual(self.verdict(), "no")
        write(self.root, "validation/src/cases/col.rs", "2")
        self.commit("case")
        write(self.root, "crates/moldwarp/src/lib.rs", "2")
        self.commit("solver")
        self.assertEqual(self.verdict(), "yes, by 2 commits")

    def test_what_the_run_wrote_counts_before_history(self):
        write(self.root, "crates/moldwarp/src/lib.rs", "2")
        new = self.commit("solver")
        write(self.root, "validation/results/fine/made.csv", f"case,commit\ncol,{new}\n")
        self.commit("computed again, the same figures")
        self.assertEqual(self.verdict(), "no")
        write(self.root, "validation/results/fine/made.csv", f"case,commit\ncol,{new}+\n")
        self.assertIn("not committed", self.verdict())
        write(self.root, "validation/results/fine/made.csv", "case,commit\ncol,1234567\n")
        self.assertIn("not known", self.verdict())

    def test_a_shallow_clone_does_not_make_results_young(self):
        write(self.root, "crates/moldwarp/src/lib.rs", "2")
        self.commit("solver")
        with tempfile.TemporaryDirectory() as folder:
            clone = Path(folder).resolve() / "clone"
            self.git("clone", "-q", "--depth", "1", self.root.as_uri(), str(clone))
            (row,) = age.ages(clone)
            self.assertIn("not known", age.verdict(row))

    def test_all_cases_of_the_chapter_have_their_files(self):
        found = dict(age.cases())
        self.assertGreater(len(found), 20)
        for case, sources in found.items():
            for source in sources:
                self.assertTrue((age.ROOT / source).exists(), f"{case}: {source}")


class Formulas(unittest.TestCase):
    def setUp(self):
        try:
            self.formulas = mathematics.Formulas()
        except ImportError:
            self.skipTest("math-core is not installed")

    def test_formulas_in_lines_and_blocks(self):
        page = self.formulas.page("a $x_1 * y$ and\n\n```math\na = b\n```\n", "page")
        self.assertEqual(page.count("<math"), 2)
        self.assertNotIn("*", page)
        self.assertNotIn("$", page)

    def test_code_prices_and_shells_are_no_formulas(self):
        page = "`$x$` costs 5 $ or 6 $.\n\n```bash\necho $a $b\n```\n\n    $ ls $HOME\n"
        self.assertEqual(self.formulas.page(page, "page"), page)

    def test_what_is_no_formula_is_an_error(self):
        with self.assertRaises(SystemExit):
            self.formulas.page("$\\nosuchcommand{x}$", "page")


class Pages(unittest.TestCase):
    def test_markdown_outside_the_book_keeps_its_name(self):
        self.assertEqual(
            mathematics.out_of_the_book("[a](../../README.md#x) [b](limits.md)", "trust.md"),
            "[a](../../README%2Emd#x) [b](limits.md)",
        )


if __name__ == "__main__":
    unittest.main()

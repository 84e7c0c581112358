"""Tests of scripts/bench: commands, summaries, remarks, the table and what is kept."""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOP = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("bench", str(TOP / "scripts" / "bench"))
bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
loader.exec_module(bench)


def row(name, ratio, better="lower", bar=None):
    result = {"name": name, "ratio": ratio, "better": better}
    return result if bar is None else dict(result, bar=bar)


def measured(*ratios, better="lower", bar=None):
    return bench.summary([[row("a", ratio, better, bar)] for ratio in ratios])["a"]


class Summary(unittest.TestCase):
    def test_takes_medians_and_extremes_over_rounds(self):
        rounds = [[row("a", 0.4), row("b", 2, "higher", 1.5)], [row("a", 0.2)], [row("a", 0.9)]]
        self.assertEqual(bench.summary(rounds), {
            "a": {"ratio": 0.4, "least": 0.2, "largest": 0.9, "better": "lower", "bar": 0},
            "b": {"ratio": 2, "least": 2, "largest": 2, "better": "higher", "bar": 1.5}})


class Verdict(unittest.TestCase):
    def test_is_silent_within_a_tenth(self):
        self.assertEqual(bench.verdict(measured(0.43), {"ratio": 0.4}), "")
        self.assertEqual(bench.verdict(measured(0.37), {"ratio": 0.4}), "")

    def test_is_silent_where_rounds_reach_the_kept_ratio(self):
        self.assertEqual(bench.verdict(measured(0.39, 0.5, 0.6), {"ratio": 0.4}), "")
        self.assertEqual(bench.verdict(measured(0.41, 0.5, 0.6), {"ratio": 0.4}), "worse")

    def test_knows_which_direction_is_better(self):
        self.assertEqual(bench.verdict(measured(2), {"ratio": 1}), "worse")
        self.assertEqual(bench.verdict(measured(1), {"ratio": 2}), "better")
        self.assertEqual(bench.verdict(measured(2, better="higher"), {"ratio": 1}), "better")
        self.assertEqual(bench.verdict(measured(1, better="higher"), {"ratio": 2}), "worse")

    def test_tells_missed_bars(self):
        self.assertEqual(bench.verdict(measured(1.2, bar=1.2), None), "")
        self.assertEqual(bench.verdict(measured(1.3, bar=1.2), {"ratio": 1}), "above its bar, worse")
        self.assertEqual(bench.verdict(measured(1.1, better="higher", bar=1.2), None), "below its bar")


class Table(unittest.TestCase):
    def test_prints_ratios_beside_kept_ones(self):
        now = bench.summary([[row("new", 0.5), row("old", 0.3, bar=0.25)]])
        kept = {"old": {"ratio": 0.2, "date": "2026-01-02"}, "gone": {"ratio": 1, "date": "2026-01-02"}}
        self.assertEqual(bench.table(now, kept), [
            "ratio     now    kept   change         of    bar",
            "new       0.5       -        -          -      -",
            "old       0.3     0.2  +50.0 % 2026-01-02   0.25 above its bar, worse"])


class Keep(unittest.TestCase):
    def test_leaves_what_other_runs_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "results" / "machine.json"
            self.assertEqual(bench.load(path), {})
            for day, rows in (("2026-01-02", [row("a", 1), row("b", 2)]),
                              ("2026-01-03", [row("b", 3, "higher", 2.5)])):
                bench.keep(path, bench.summary([rows]), "A \"fast\" one", 2, "g++ 12", day)
            self.assertEqual(json.loads(path.read_text())["cpu"], "A \"fast\" one")
            kept = bench.load(path)
            self.assertEqual((kept["a"]["ratio"], kept["a"]["date"]), (1, "2026-01-02"))
            self.assertEqual(kept["b"], {"ratio": 3, "least": 3, "largest": 3, "better": "higher", "bar": 2.5,
                                         "date": "2026-01-03", "compiler": "g++ 12"})

    def test_names_files_by_processor_and_cores(self):
        names = {("AMD EPYC 9R14 96-Core Processor", 2): "amd-epyc-9r14-2-cores.json",
                 ("Intel(R) Xeon(R) Platinum 8488C CPU @ 2.40GHz", 4): "intel-xeon-platinum-8488c-4-cores.json"}
        for machine, name in names.items():
            self.assertEqual(bench.results_file(*machine).name, name)


class Run(unittest.TestCase):
    def write(self, folder, text):
        program = pathlib.Path(folder) / "program"
        program.write_text("#!/bin/sh\n" + text)
        program.chmod(0o755)
        return [str(program)]

    def test_reads_ratios_that_a_program_reports(self):
        with tempfile.TemporaryDirectory() as folder:
            line = json.dumps(row("a", 0.25, bar=1))
            command = self.write(folder, f"echo 'ratio 7'; echo '{line}' >> \"$DELRAY_RATIOS\"\n")
            self.assertEqual(bench.run_once("x", command, False), [row("x: a", 0.25, bar=1)])

    def test_tells_failures_from_programs_without_ratios(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(bench.run_once("x", self.write(folder, "exit 0\n"), False), [])
            self.assertIsNone(bench.run_once("x", self.write(folder, "exit 3\n"), False))


class Commands(unittest.TestCase):
    def test_put_models_in_place(self):
        self.assertEqual(bench.arguments_of("gen:a primary:MODELS", ["x.obj", "y.ply"]),
                         ["gen:a", "primary:x.obj", "primary:y.ply"])
        self.assertEqual(bench.arguments_of("gen:a MODELS", []), ["gen:a"])
        self.assertIsNone(bench.arguments_of("MODELS", []))

    def test_cover_every_program_that_reports_ratios(self):
        cmake = (TOP / "bench" / "CMakeLists.txt").read_text()
        programs = dict(re.findall(r"add_executable\((\S+) (\S+\.cpp)\)", cmake))
        # Those that stand beside another build of themselves need one.
        reporting = {name for name, source in programs.items()
                     if "report_ratio(" in (text := (TOP / "bench" / source).read_text())
                     and "--beside" not in text}
        run = {benchmark[2].split()[0] for benchmark in bench.BENCHMARKS}
        self.assertTrue(reporting)
        self.assertEqual(reporting, {name for name in run if not name.endswith(".py")})
        page = (TOP / "docs" / "performance.md").read_text()
        for name in run:
            self.assertIn(name, page)

    def test_say_why_a_program_cannot_run(self):
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder)
            slow = ("slow", 0, "program --long", None)
            self.assertIn("--quick", bench.command_of(slow, build, True, []))
            self.assertIn("not built", bench.command_of(slow, build, False, []))
            (build / "bench").mkdir()
            (build / "bench" / "program").touch()
            self.assertEqual(bench.command_of(slow, build, False, [])[1:], ["--long"])
            self.assertEqual(bench.command_of(("m", 2, "program", "-q"), build, True, [])[:4],
                             ["mpirun", "--oversubscribe", "-n", "2"])


unittest.main()

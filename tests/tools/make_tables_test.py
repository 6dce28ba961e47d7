"""The page of benchmarks: it agrees with the figures, and shows what the figures say."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_tables  # noqa: E402

HEADER = ("date,commit,machine,scene,engine,settings,threads,steps,rounds,mean_ms,median_ms,worst_ms,min_ms,mean_ms_low,"
          "mean_ms_high,bodies,contacts,hash,top_height,mean_height,drift\n")


def row(engine, median, date="2026-01-02", machine="Chip x 2"):
    name = "ab12" if engine == "fase" else ""
    return (f'{date},c0ffee,{machine},wall,{engine},"a, b",1,200,3,{median},{median},9,{median},1,2,55,145,{name},9.5,3.5,'
            "0.001\n")


class MakeTables(unittest.TestCase):
    def write(self, *rows):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = Path(folder.name)
        (root / "bench/results").mkdir(parents=True)
        (root / "docs").mkdir()
        (root / make_tables.FIGURES).write_text(HEADER + "".join(rows), encoding="utf-8")
        return root

    def test_the_page_agrees_with_the_figures(self):
        self.assertEqual(make_tables.main(["--check", str(ROOT)]), 0)

    def test_a_changed_figure_is_found(self):
        root = self.write(row("fase", 2))
        self.assertEqual(make_tables.main([str(root)]), 0)
        self.assertEqual(make_tables.main(["--check", str(root)]), 0)
        page = root / make_tables.PAGE
        page.write_text(page.read_text(encoding="utf-8").replace("2.00", "1.00"), encoding="utf-8")
        tool = [sys.executable, "-B", str(ROOT / "tools/make_tables.py"), "--check", str(root)]
        answer = subprocess.run(tool, capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, 1)
        self.assertIn("docs/benchmarks.md: found other figures", answer.stdout)

    def test_the_last_row_counts_and_peers_are_compared_with_fase(self):
        root = self.write(row("fase", 4), row("bullet", 8), row("fase", 2), row("bullet", 7))
        rows = make_tables.read_rows(root / make_tables.FIGURES)
        self.assertEqual([one["median_ms"] for one in rows], ["2", "7"])
        page = make_tables.page_of(rows)
        self.assertIn("| wall | bullet | 1 | 55 | 7.00 | 7.00 | 9.00 | 7.00 | 3.50 (3.50) |", page)
        self.assertIn("| wall | fase | 1 | 55 | 2.00 | 2.00 | 9.00 | 2.00 |  |", page)

    def test_figures_of_other_days_and_machines_are_not_compared(self):
        rows = make_tables.read_rows(self.write(row("fase", 4), row("bullet", 8, date="2026-01-03")) / make_tables.FIGURES)
        self.assertEqual(make_tables.times_of(rows[1], rows), "")
        page = make_tables.page_of(make_tables.read_rows(
            self.write(row("fase", 4), row("fase", 1, machine="Other x 8")) / make_tables.FIGURES))
        self.assertEqual(page.count("\n## "), 2)

    def test_queries_stand_a_line_a_contender(self):
        root = self.write(row("fase", 2))
        head = ("date,commit,machine,scene,contender,settings,kind,things,rounds,asked,per_second,low,high,hits,compared,"
                "differ,build_ms,bytes\n")
        line = "2026-01-02,c0ffee,Chip x 2,static,{},{},{},100,3,50,{},1000,2000000,9,50,{},12.5,{}\n"
        (root / make_tables.QUERY_FIGURES).write_text(
            head + line.format("wide_bvh", "as it comes", "rays", "900000", 0, 5000)
            + line.format("wide_bvh", "as it comes", "rays", "1500000", 0, 5000)
            + line.format("wide_bvh", "as it comes", "frusta", "12345", 0, 5000)
            + line.format("embree", "one ray", "rays", "3000000", 2, ""), encoding="utf-8")
        self.assertEqual(make_tables.main([str(root)]), 0)
        page = (root / make_tables.PAGE).read_text(encoding="utf-8")
        self.assertIn("| wide_bvh | 1500 (1.00–2000) |  | 12.3 (1.00–2000) | 0 | 12.5 | 50 | c0ffee | 2026-01-02 |", page)
        self.assertIn("| embree | 3000 (1.00–2000) |  |  | 2 | 12.5 |  | c0ffee | 2026-01-02 |", page)
        self.assertIn("\nembree: one ray.\n", page)

    def test_levels_are_summed_and_stand_map_by_map(self):
        root = self.write(row("fase", 2))
        head = ("machine,date,commit,compiler,settings,wad,map,lines,sides,segs,splits,nodes,subsectors,mean_depth,worst_depth,"
                "cpu_seconds,wall_seconds,bulge,area_error\n")
        line = "Chip,2026-01-02,c0ffee,{},as it comes,{},{},100,200,{},{},40,50,{},9,0.5,0.75,1,0\n"
        (root / make_tables.LEVEL_FIGURES).write_text(
            head + line.format("fase", "a.wad", "all", 220, 20, 6) + line.format("fase", "b.wad", "all", 240, 40, 8)
            + line.format("fase", "a.wad", "MAP01", 220, 20, 6) + line.format("zdbsp", "a.wad", "all", 250, 50, 7)
            + line.format("zdbsp", "a.wad", "MAP01", 250, 50, 7), encoding="utf-8")
        self.assertEqual(make_tables.main([str(root)]), 0)
        page = (root / make_tables.PAGE).read_text(encoding="utf-8")
        self.assertIn("| fase | 1 | 460 | 15.00 | 80 | 7.000 | 9 | 1.00 | 1.50 |", page)
        self.assertIn("| MAP01 | 100 | 200 | 220 (10.0), 40, 6.00, 9, 500.0 | 250 (25.0), 40, 7.00, 9, 500.0 |", page)


if __name__ == "__main__":
    unittest.main()

"""Benchmark pages and charts: they agree with the CSV files, and show what the figures say."""
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import benchmark_tables as tables  # noqa: E402
import make_charts  # noqa: E402
import make_tables  # noqa: E402
import svg  # noqa: E402

STEP_HEADER = ("date,commit,machine,scene,engine,settings,threads,steps,rounds,mean_ms,median_ms,worst_ms,min_ms,mean_ms_low,"
               "mean_ms_high,bodies,contacts,hash,top_height,mean_height,drift\n")


def row(engine, median, date="2026-01-02", machine="Chip x 2"):
    name = "ab12" if engine == "fase" else ""
    return (f'{date},c0ffee,{machine},wall,{engine},"a, b",1,200,3,{median},{median},9,{median},1,2,55,145,{name},9.5,3.5,'
            "0.001\n")


class Repository(unittest.TestCase):
    """A folder with the CSV files that a test needs."""

    def write(self, *rows):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = Path(folder.name)
        (root / "bench/results").mkdir(parents=True)
        (root / "docs").mkdir()
        (root / tables.STEP_FIGURES).write_text(STEP_HEADER + "".join(rows), encoding="utf-8")
        return root

    def appendix(self, root):
        self.assertEqual(make_tables.main([str(root)]), 0)
        return (root / make_tables.APPENDIX).read_text(encoding="utf-8")


class Tables(Repository):
    def test_pages_and_charts_agree_with_the_figures(self):
        self.assertEqual(make_tables.main(["--check", str(ROOT)]), 0)
        self.assertEqual(make_charts.main(["--check", str(ROOT)]), 0)

    def test_an_edited_page_or_chart_fails_the_check(self):
        for path in (make_tables.PAGE, make_tables.APPENDIX, "docs/pictures/step.svg"):
            with self.subTest(path=path):
                root = self.write(row("fase", 2), row("bullet", 8))
                self.assertEqual(make_tables.main([str(root)]), 0)
                self.assertEqual(make_tables.main(["--check", str(root)]), 0)
                page = root / path
                page.write_text(page.read_text(encoding="utf-8").replace("2.00", "1.00"), encoding="utf-8")
                tool = [sys.executable, "-B", str(ROOT / "tools/make_tables.py"), "--check", str(root)]
                answer = subprocess.run(tool, capture_output=True, text=True, check=False)
                self.assertEqual(answer.returncode, 1)
                self.assertIn(f"{path}: differs from the figures", answer.stdout)

    def test_the_last_row_counts_and_peers_are_compared_with_fase(self):
        root = self.write(row("fase", 4), row("bullet", 8), row("fase", 2), row("bullet", 7))
        rows = tables.step_rows(root / tables.STEP_FIGURES)
        self.assertEqual([one["median_ms"] for one in rows], ["2", "7"])
        page = self.appendix(root)
        self.assertIn("| wall | bullet | 1 | 55 | 7.00 | 7.00 | 9.00 | 7.00 | 3.50 (3.50) |", page)
        self.assertIn("| wall | fase | 1 | 55 | 2.00 | 2.00 | 9.00 | 2.00 |  |", page)

    def test_the_summary_divides_the_peer_by_fase(self):
        root = self.write(row("fase", 2), row("bullet", 7))
        self.assertEqual(make_tables.main([str(root)]), 0)
        page = (root / make_tables.PAGE).read_text(encoding="utf-8")
        self.assertIn("| a step | wall, 55 bodies | 2.00 ms | Bullet: 7.00 ms | 3.50× |", page)

    def test_figures_of_different_days_or_machines_are_not_compared(self):
        rows = tables.step_rows(self.write(row("fase", 4), row("bullet", 8, date="2026-01-03")) / tables.STEP_FIGURES)
        self.assertEqual(tables.ratio_of(rows[1], rows), "")
        page = self.appendix(self.write(row("fase", 4), row("fase", 1, machine="Other x 8")))
        self.assertEqual(page.count("\n### "), 2)

    def test_queries_have_one_line_per_contender(self):
        root = self.write(row("fase", 2))
        head = ("date,commit,machine,scene,contender,settings,kind,things,rounds,asked,per_second,low,high,hits,compared,"
                "differ,build_ms,bytes\n")
        line = "2026-01-02,c0ffee,Chip x 2,static,{},{},{},100,3,50,{},1000,2000000,9,50,{},12.5,{}\n"
        (root / tables.QUERY_FIGURES).write_text(
            head + line.format("wide_bvh", "default", "rays", "900000", 0, 5000)
            + line.format("wide_bvh", "default", "rays", "1500000", 0, 5000)
            + line.format("wide_bvh", "default", "frusta", "12345", 0, 5000)
            + line.format("embree", "one ray", "rays", "3000000", 2, ""), encoding="utf-8")
        page = self.appendix(root)
        self.assertIn("| wide_bvh | 1500 (1.00–2000) |  | 12.3 (1.00–2000) | 0 | 12.5 | 50 | c0ffee | 2026-01-02 |", page)
        self.assertIn("| embree | 3000 (1.00–2000) |  |  | 2 | 12.5 |  | c0ffee | 2026-01-02 |", page)
        self.assertIn("\nembree: one ray.\n", page)

    def test_levels_are_summed_and_listed_by_map(self):
        root = self.write(row("fase", 2))
        head = ("machine,date,commit,compiler,settings,wad,map,lines,sides,segs,splits,nodes,subsectors,mean_depth,worst_depth,"
                "cpu_seconds,wall_seconds,bulge,area_error\n")
        line = "Chip,2026-01-02,c0ffee,{},default,{},{},100,200,{},{},40,50,{},9,0.5,0.75,1,0\n"
        (root / tables.LEVEL_FIGURES).write_text(
            head + line.format("fase", "a.wad", "all", 220, 20, 6) + line.format("fase", "b.wad", "all", 240, 40, 8)
            + line.format("fase", "a.wad", "MAP01", 220, 20, 6) + line.format("zdbsp", "a.wad", "all", 250, 50, 7)
            + line.format("zdbsp", "a.wad", "MAP01", 250, 50, 7), encoding="utf-8")
        page = self.appendix(root)
        self.assertIn("| fase | 1 | 460 | 15.00 | 80 | 7.000 | 9 | 1.00 | 1.50 |", page)
        self.assertIn("| MAP01 | 100 | 200 | 220 (10.0), 40, 6.00, 9, 500.0 | 250 (25.0), 40, 7.00, 9, 500.0 |", page)


class Charts(Repository):
    def test_a_chart_is_drawn_for_each_csv_file_that_has_figures(self):
        root = self.write(row("fase", 2), row("bullet", 7))
        self.assertEqual([path.name for path in make_charts.charts_of(root)], ["step.svg"])
        self.assertEqual(make_charts.charts_of(self.write(row("fase", 2))), {})
        self.assertEqual(len(make_charts.charts_of(ROOT)), 6)

    def test_the_same_figures_give_the_same_text_without_a_date(self):
        first, again = make_charts.charts_of(ROOT), make_charts.charts_of(ROOT)
        self.assertEqual(first, again)
        for text in first.values():
            self.assertNotIn("2026-", text)

    def test_charts_have_a_title_and_text_within_the_sheet(self):
        for path, text in make_charts.charts_of(ROOT).items():
            sheet = xml.fromstring(text)
            height = float(sheet.get("height"))
            self.assertTrue(sheet.findtext("{http://www.w3.org/2000/svg}title"))
            for label in sheet.iter("{http://www.w3.org/2000/svg}text"):
                if label.get("transform"):
                    continue
                width = svg.text_width(label.text, 10)  # about the mean width of a letter of 12 pixels
                left = float(label.get("x")) - {"end": width, "middle": width / 2}.get(label.get("text-anchor"), 0)
                with self.subTest(chart=path.name, text=label.text):
                    self.assertGreaterEqual(left, 0)
                    self.assertLessEqual(left + width, svg.WIDTH)
                    self.assertLess(float(label.get("y")), height)

    def test_bars_are_as_long_as_their_figures(self):
        root = self.write(row("fase", 2), row("bullet", 8))
        sheet = xml.fromstring(make_charts.charts_of(root)[root / "docs/pictures/step.svg"])
        widths = [float(bar.get("width")) for bar in sheet.iter("{http://www.w3.org/2000/svg}rect")][-2:]
        self.assertAlmostEqual(widths[1] / widths[0], 4, places=2)

    def test_numbers_have_about_three_digits(self):
        self.assertEqual([svg.number(value) for value in (0.284, 5.186, 63.04, 1083.6)], ["0.28", "5.19", "63.0", "1,084"])
        self.assertEqual([svg.magnitude(value) for value in (840, 24291, 2116133)], ["840", "24.3 k", "2.12 M"])

    def test_labels_that_would_overlap_are_moved_apart(self):
        self.assertEqual(svg.spread([10, 12, 50], 15), [10, 25, 50])


if __name__ == "__main__":
    unittest.main()

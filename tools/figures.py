"""Shared by the measuring tools: the origin of figures, and writing of CSV files."""
import csv
import datetime
import platform
import subprocess
from pathlib import Path


def machine_name():
    """Returns the name of the processor."""
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def origin_of(repository):
    """Returns machine, date and commit, under the names of the first columns of each CSV file."""
    commit = subprocess.run(["git", "-C", repository, "rev-parse", "--short", "HEAD"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    return {"machine": machine_name(), "date": datetime.date.today().isoformat(), "commit": commit}


def write_table(path, fields, rows):
    """Overwrites a CSV file with these columns and rows."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)

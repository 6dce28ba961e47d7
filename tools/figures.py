"""What the tools that measure share: where figures come from, and how they are written."""
import csv
import datetime
import platform
import subprocess
from pathlib import Path


def machine_name():
    """The processor's name."""
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def origin_of(repository):
    """Machine, date and commit, as the first columns of each table name them."""
    commit = subprocess.run(["git", "-C", repository, "rev-parse", "--short", "HEAD"], check=True, stdout=subprocess.PIPE,
                            text=True).stdout.strip()
    return {"machine": machine_name(), "date": datetime.date.today().isoformat(), "commit": commit}


def write_table(path, fields, rows):
    """A CSV file with these columns, anew."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)

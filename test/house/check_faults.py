#!/usr/bin/env python3
"""Checks that every line of the README's fault list names a test that there is.

check_faults.py ROOT   exit 1 and one line for each name that no test has, or each line without one
"""
import re
import sys
from pathlib import Path

HEAD = "| cause | what happens | test |"


def main(root):
    lines = (root / "README.md").read_text(encoding="utf-8").split(HEAD)[1].splitlines()[2:]
    rows = [line for line in lines[:next(k for k, line in enumerate(lines) if not line.startswith("|"))]]
    problems = []
    for row in rows:
        names = re.findall(r"`(\w+): (\w+)`", row.rsplit("|", 2)[1])
        if not names:
            problems.append("no test behind: " + row)
        for file, test in names:
            sources = list(root.glob(f"test/*/test_{file}.py")) + list(root.glob(f"test/*/test_{file}.cpp"))
            pattern = re.compile(rf"def test_{test}\(|TEST(_F)?\(\w+, {test}\)")
            if not any(pattern.search(source.read_text(encoding="utf-8")) for source in sources):
                problems.append(f"README.md names the test {file}: {test}, which test/ does not have")
    print("\n".join(problems) or f"{len(rows)} faults, each with a test")
    return 1 if problems or not rows else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))

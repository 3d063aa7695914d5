"""Reads files as the reader that their folder is named for: python -m tests.fuzz.replay FOLDER FILE..."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from tests.fuzz.child import ROOM, attempt, limit_memory, report_ends
from tests.fuzz.readers import READERS


def main() -> None:
    """The command; FOLDER is for its own files. Writes a file's name and the message, null for one that is read."""
    report_ends()
    folder = Path(sys.argv[1])
    for path in map(Path, sys.argv[2:]):
        (folder / "reader").write_text(f"{path.parent.name}, {path.name}")
        reader = READERS[path.parent.name]
        for content in reader.seeds():
            attempt(reader, folder, content)
        limit_memory(ROOM)
        print(json.dumps({path.name: attempt(reader, folder, path.read_bytes())}), flush=True)


if __name__ == "__main__":
    main()

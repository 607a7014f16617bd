"""Times whole commands in turn: processor and wall seconds of each to a JSON file.

time_commands.py --rounds=N --json=FILE --command NAME WORD... --command NAME WORD...
Standard library only.
"""

import json
import os
import pathlib
import sys
import time


def run(words):
    """Runs a command with its output thrown away: (user + system, wall) in seconds."""
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        nothing = os.open(os.devnull, os.O_RDWR)
        for descriptor in (0, 1, 2):
            os.dup2(nothing, descriptor)
        try:
            os.execvp(words[0], words)
        finally:
            os._exit(127)
    _, status, usage = os.wait4(child, 0)
    wall = time.monotonic() - start
    if status != 0:
        sys.exit(f"time_commands.py: {' '.join(words)}: status {os.waitstatus_to_exitcode(status)}")
    return usage.ru_utime + usage.ru_stime, wall


def main():
    words = sys.argv[1:]
    first = words.index("--command") if "--command" in words else len(words)
    options = dict(word.lstrip("-").split("=", 1) for word in words[:first])
    commands = {}
    for word in words[first:]:
        if word == "--command":
            current = []
        else:
            current.append(word)
            commands[current[0]] = current[1:]
    if not commands or "json" not in options:
        sys.exit(__doc__)
    samples = {name: {"cpu": [], "wall": []} for name in commands}
    for _ in range(int(options.get("rounds", 5))):
        for name, command in commands.items():
            cpu, wall = run(command)
            samples[name]["cpu"].append(cpu)
            samples[name]["wall"].append(wall)
    text = json.dumps(samples, indent=1) + "\n"
    pathlib.Path(options["json"]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

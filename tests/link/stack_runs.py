"""Runs of a scenario with stacks in other processes, for the tests of the turn protocol."""
import pathlib
import subprocess
import sys

from mcap.reader import make_reader

PATROL, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
PYTHON = sys.executable


def write_stack(folder, name, text):
    """Writes a Python program and returns the command that starts it."""
    path = pathlib.Path(folder) / name
    path.write_text(text)
    return f"{PYTHON} {path}"


def run(out, stack=None, seed=1, time_limit_s=4.0, settings=(), threads=None):
    """Runs street/short until the time limit and returns the finished process."""
    command = [PATROL, "run", "street/short", "--seed", str(seed), "--out", str(out), "--set", f"time_limit_s={time_limit_s}"]
    for setting in settings:
        command += ["--set", setting]
    if stack is not None:
        command += ["--stack", stack]
    if threads is not None:
        command += ["--threads", str(threads)]
    return subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, timeout=280)


def verify(run_directory, stack=None):
    command = [PATROL, "verify", str(run_directory)] + (["--stack", stack] if stack else [])
    return subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, timeout=280)


def feed(run_directory, out, stack=None):
    command = [PATROL, "feed", str(run_directory), "--out", str(out)] + (["--stack", stack] if stack else [])
    return subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, timeout=280)


def messages(run_directory):
    """Topic, time and bytes of the messages of a run's log in file order."""
    with open(pathlib.Path(run_directory) / "log.mcap", "rb") as file:
        return [(channel.topic, message.log_time, message.data)
                for _, channel, message in make_reader(file).iter_messages(log_time_order=False)]


def without_turns(all_messages):
    return [one for one in all_messages if one[0] != "/stack/turns"]

"""Calls of the program by the tools, with their processor time."""
import resource
import subprocess


class InputError(Exception):
    """One line for the user."""


def processor_s(words, folder=None):
    """Processor time of a command, s. Throws InputError where it refuses its input, RuntimeError where it fails; a missed expectation (1) and the time
    limit (4) are neither."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 1, 4):
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        if done.returncode == 2:
            raise InputError(last)
        raise RuntimeError(f"{' '.join(map(str, words))}: exit code {done.returncode}: {last}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

#!/usr/bin/env python3
"""A sweep on a real Slurm cluster: slurmctld and two slurmd of Debian's packages on this host, on loopback.

usage: slurm_test.py PATROL SOURCE_DIR; exits 77 where Slurm is not installed
"""
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import sys
import time
import unittest

from sweeping import SOURCE, SweepCase

HOST = socket.gethostname().split(".")[0]
CONFIGURATION = """\
ClusterName=patrol
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool_%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd_%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd_%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
MinJobAge=2
NodeName=patrol1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 State=UNKNOWN
NodeName=patrol2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    """Two nodes and a controller, in a folder of their own."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "state").mkdir(parents=True)
        user = pwd.getpwuid(os.getuid()).pw_name
        (folder / "slurm.conf").write_text(CONFIGURATION.format(host=HOST, folder=folder, user=user, ports=free_ports(3)))
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
        self.daemons = [self.start("slurmctld", "-D", "-i")]
        for node in ("patrol1", "patrol2"):
            (folder / f"spool_{node}").mkdir()
            self.daemons.append(self.start("slurmd", "-D", "-N", node))
        deadline = time.monotonic() + 60
        while self.ask("sinfo", "-h", "-o", "%T") != "idle":
            if time.monotonic() > deadline:
                raise RuntimeError("the cluster does not come up:\n" + (folder / "slurmctld.log").read_text()[-2000:])
            time.sleep(0.5)

    def start(self, *command):
        with open(self.folder / "daemons.log", "a") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, start_new_session=True)

    def ask(self, *command):
        return subprocess.run(command, capture_output=True, text=True).stdout.strip()

    def stop(self):
        subprocess.run(["scancel", "--user", pwd.getpwuid(os.getuid()).pw_name], capture_output=True)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()


class Slurm(SweepCase):
    vary = (*SweepCase.vary[:-1], "3")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.cluster = Cluster(cls.path / "cluster")

    @classmethod
    def tearDownClass(cls):
        cls.cluster.stop()
        super().tearDownClass()

    def test_three_shards_on_two_nodes_leave_the_bytes_of_a_local_sweep(self):
        out = self.path / "cluster_sweep"
        done = self.sweep(out, *self.vary, "--engine", "slurm", "--slurm-tasks", "3")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same_tables(out)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)  # one submission

    def test_a_task_killed_midway_is_submitted_again(self):
        out = self.path / "killed_task"
        # One task: the one that has left the first result is the one that is killed, before the next.
        process = self.start(out, *self.vary, "--engine", "slurm", "--slurm-tasks", "1")
        deadline = time.monotonic() + 60
        while not list((out / "runs").glob("*.json")) and time.monotonic() < deadline:
            time.sleep(0.05)
        job = (out / "slurm/job").read_text()
        subprocess.run(["scancel", "--signal=KILL", "--full", f"{job}_1"], check=True)
        shown, said = process.communicate(timeout=280)
        self.assertEqual(process.returncode, 0, shown + said)
        self.assert_same_tables(out)
        self.assertEqual(said.count("\n"), 2, said)  # a second submission, of what was missing

    def test_detached_it_returns_and_the_same_call_collects(self):
        out = self.path / "detached"
        call = (*self.vary, "--engine", "slurm", "--slurm-tasks", "2")
        done = self.sweep(out, *call, "--detach")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("is running", done.stdout)
        self.assertTrue((out / "INCOMPLETE").exists())
        self.assertEqual(self.sweep(out, *call).returncode, 0)
        self.assert_same_tables(out)

    def test_a_controller_that_does_not_answer_once_is_asked_again(self):
        folder = self.path / "programs"
        folder.mkdir()
        squeue = folder / "squeue"
        squeue.write_text(f"#!/bin/sh\n[ -e {folder}/failed ] || {{ touch {folder}/failed; exit 1; }}\n"
                          f'exec {shutil.which("squeue")} "$@"\n')
        squeue.chmod(0o755)
        out = self.path / "controller_restarts"
        done = subprocess.run(self.command(out, *self.vary, "--engine", "slurm", "--slurm-tasks", "2"), text=True,
                              capture_output=True, cwd=SOURCE, timeout=280,
                              env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((folder / "failed").exists())
        self.assert_same_tables(out)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)  # one submission

    def test_what_sbatch_refuses_is_3(self):
        done = self.sweep(self.path / "refused", *self.vary, "--engine", "slurm", "--slurm-option=--partition=none")
        self.assertEqual(done.returncode, 3)
        self.assertIn("sbatch failed", done.stderr)


if __name__ == "__main__":
    if not all(shutil.which(program) for program in ("slurmctld", "slurmd", "sbatch")):
        print("skipped: Slurm is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])

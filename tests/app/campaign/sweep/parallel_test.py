#!/usr/bin/env python3
"""Shards of a sweep shared out by GNU parallel over ssh: two hosts, which are both this one, by an sshd of the test's own on loopback.

usage: parallel_test.py PATROL SOURCE_DIR; exits 77 where parallel or sshd are not installed
"""
import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time
import unittest

from sweeping import PATROL, SOURCE, SweepCase

SSHD = shutil.which("sshd", path=os.environ["PATH"] + ":/usr/sbin:/sbin")


class SshHosts:
    """`patrol1` and `patrol2`, by a key of their own."""

    def __init__(self, folder):
        folder.mkdir(mode=0o700)
        for key in ("host", "user"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / key], check=True)
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        (folder / "sshd_config").write_text(
            f"Port {port}\nListenAddress 127.0.0.1\nHostKey {folder}/host\nAuthorizedKeysFile {folder}/user.pub\nStrictModes no\n"
            f"PidFile {folder}/sshd.pid\nPasswordAuthentication no\nPermitRootLogin prohibit-password\n")
        self.client = folder / "ssh_config"
        self.client.write_text(
            f"Host patrol1 patrol2\n  HostName 127.0.0.1\n  Port {port}\n  User {getpass.getuser()}\n  IdentityFile {folder}/user\n"
            f"  IdentitiesOnly yes\n  UserKnownHostsFile {folder}/known\n  StrictHostKeyChecking no\n  LogLevel ERROR\n")
        if os.getuid() == 0:
            pathlib.Path("/run/sshd").mkdir(exist_ok=True)
        self.daemon = subprocess.Popen([SSHD, "-D", "-f", folder / "sshd_config"], stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 20
        while subprocess.run(["ssh", "-F", self.client, "patrol1", "true"], capture_output=True).returncode != 0:
            if time.monotonic() > deadline or self.daemon.poll() is not None:
                self.stop()
                raise unittest.SkipTest(f"sshd does not let us in: {self.daemon.stderr.read()[-500:]}")
            time.sleep(0.2)

    def stop(self):
        self.daemon.terminate()
        self.daemon.wait()


class Parallel(SweepCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.hosts = SshHosts(cls.path / "ssh")

    @classmethod
    def tearDownClass(cls):
        cls.hosts.stop()
        super().tearDownClass()

    def test_four_shards_on_two_hosts_leave_the_bytes_of_a_local_sweep(self):
        out = self.path / "over_ssh"
        done = subprocess.run(["parallel", "--will-cite", "--ssh", f"ssh -F {self.hosts.client}", "-S", "1/patrol1,1/patrol2", "--workdir", str(SOURCE),
                               *self.command(out, *self.vary), "--jobs", "1", "--shard", "{}/4", ":::", "1", "2", "3", "4"],
                              capture_output=True, text=True, timeout=280)
        self.assertEqual(done.returncode, 0, done.stderr)
        collected = subprocess.run([PATROL, "merge", out], capture_output=True, text=True)
        self.assertEqual(collected.returncode, 0, collected.stderr)
        self.assert_same_tables(out)


if __name__ == "__main__":
    if SSHD is None or not all(shutil.which(program) for program in ("parallel", "ssh", "ssh-keygen")):
        print("skipped: GNU parallel or sshd is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "-v"])

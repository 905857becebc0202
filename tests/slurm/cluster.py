"""A cluster of Slurm's own daemons, two nodes on this computer, in a folder."""
import contextlib
import getpass
import os
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch"]
PATIENCE = 600  # Seconds; only says that something hangs.

CONFIGURATION = """
ClusterName=candela-test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock,cred_expire=5
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=30
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]


def wait_until(what, condition):
    """Waits for the value of condition(), which must come."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.1)
    raise AssertionError(f"waited in vain: {what}")


class Cluster:
    """Daemons that live in a folder as long as the context."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        self.environment = os.environ | {"SLURM_CONF": str(folder / "slurm.conf")}

    def __enter__(self):
        for name in ("state", "spool-n1", "spool-n2"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, user=getpass.getuser(), host=socket.gethostname().split(".")[0], ports=free_ports(3)))
        # Newer versions would otherwise start only where control groups are mounted; older ones do not know the word.
        if int(self.run("slurmctld", "-V").split()[1].split(".")[0]) >= 23:  # slurm-wlm 24.11.5
            (self.folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        try:
            self.start("munged", "--foreground", "--force", f"--key-file={key}",
                       f"--socket={self.folder}/munge.sock", f"--pid-file={self.folder}/munged.pid",
                       f"--seed-file={self.folder}/munge.seed", f"--log-file={self.folder}/munged.log")
            wait_until("munged", (self.folder / "munge.sock").exists)
            self.start("slurmctld", "-D", "-i")
            for node in ("n1", "n2"):
                self.start("slurmd", "-D", "-N", node)
            wait_until("nodes", self.has_idle_nodes)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        self.run("scancel", "--me", check=False)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(60)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def start(self, *command):
        with open(self.folder / "daemons.log", "ab") as log:
            self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log,
                                                 stdin=subprocess.DEVNULL, cwd=self.folder))

    def has_idle_nodes(self):
        if any(daemon.poll() is not None for daemon in self.daemons):
            raise AssertionError("a daemon has ended: " + (self.folder / "daemons.log").read_text(errors="replace"))
        return self.run("sinfo", "--noheader", "--Node", "--format=%T", check=False).count("idle") == 2

    def run(self, *command, check=True, **more):
        """Runs the command and returns what it prints."""
        result = subprocess.run([str(word) for word in command], env=self.environment | more, cwd=self.folder,
                                capture_output=True, text=True, check=False)
        if check and result.returncode != 0:
            raise AssertionError(f"{command} ended with {result.returncode}: {result.stdout}{result.stderr}")
        return result.stdout

    def set_nodes(self, nodes, state):
        self.run("scontrol", "update", f"NodeName={nodes}", f"State={state}", "Reason=test")

    def state(self, job):
        """The state of a job or a task; nothing if Slurm does not know it."""
        fields = self.run("scontrol", "show", "job", job, check=False).split()
        return next((field.split("=")[1] for field in fields if field.startswith("JobState=")), None)

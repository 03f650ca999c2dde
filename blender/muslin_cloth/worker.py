"""Runs the muslin program as a separate process. Needs no Blender."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None

PROGRAM = "muslin.exe" if sys.platform == "win32" else "muslin"


def find_program(preferred=""):
    """Returns the program of the preferences, or beside the add-on, or on the PATH; "" if there is none."""
    bundled = pathlib.Path(__file__).parent / "bin" / PROGRAM
    if bundled.is_file() and not os.access(bundled, os.X_OK):  # installers of Blender unpack without permissions
        try:
            bundled.chmod(0o755)
        except OSError:
            pass
    for candidate in (preferred, str(bundled)):
        if candidate and os.path.isfile(candidate) and os.access(candidate, os.X_OK):
            return os.path.abspath(candidate)
    return "" if preferred else shutil.which(PROGRAM) or ""


def quiet_process():
    """Without a console window on Windows, and out of reach of a Ctrl-C meant for Blender."""
    if sys.platform == "win32":
        return {"creationflags": subprocess.CREATE_NO_WINDOW | subprocess.CREATE_NEW_PROCESS_GROUP}
    return {"start_new_session": True}


def ask(program, *words):
    """Runs a command that ends soon: (exit code, stdout, stderr)."""
    done = subprocess.run([program, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          errors="replace", check=False, **quiet_process())
    return done.returncode, done.stdout, done.stderr


class Question:
    """Several commands after each other in the background; `answers` are as of ask()."""

    def __init__(self, program, commands):
        self._program, self._commands = program, commands
        self._process, self._cancelled, self._lock = None, False, threading.Lock()
        self.answers, self.error = [], ""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        try:
            for words in self._commands:
                with self._lock:
                    if self._cancelled:
                        return
                    self._process = subprocess.Popen([self._program, *words], stdin=subprocess.DEVNULL,
                                                     stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                                     errors="replace", **quiet_process())
                out, err = self._process.communicate()
                self.answers.append((self._process.returncode, out, err))
        except OSError as error:
            self.error = str(error)

    def done(self):
        return not self._thread.is_alive()

    def cancel(self):
        with self._lock:
            self._cancelled = True
            if self._process and self._process.poll() is None:
                self._process.kill()


class Worker:
    """A separate process that survives a crash of Blender."""

    def __init__(self, program, words, log):
        with open(log, "wb") as out:
            self._process = subprocess.Popen([program, *words], stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                             **quiet_process())
        self.log, self.pid = log, self._process.pid

    def ended(self):
        """Exit code, negative for a signal, or None while it runs."""
        return self._process.poll()

    def interrupt(self):
        if self._process.poll() is None:
            self._process.send_signal(signal.CTRL_BREAK_EVENT if sys.platform == "win32" else signal.SIGINT)

    def kill(self):
        if self._process.poll() is None:
            self._process.kill()

    def wait(self, seconds):
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            pass

    def problem(self):
        return read_log(self.log)


class Orphan:
    """The worker of a Blender that crashed, known by the lock on its run directory."""

    def __init__(self, run, pid, log):
        self._run, self.pid, self.log = pathlib.Path(run), pid, log

    def ended(self):
        if is_locked(self._run):
            return None
        status = run_status(self._run)
        codes = {"finished": 0, "interrupted": 130, "failed": 4}
        return codes.get(status, -signal.SIGTERM)

    def _signal(self, number):
        if self.ended() is None and _is_muslin(self.pid):
            os.kill(self.pid, number)

    def interrupt(self):
        self._signal(signal.SIGINT)

    def kill(self):
        self._signal(signal.SIGKILL)

    def wait(self, seconds):
        pass

    def problem(self):
        return read_log(self.log)


def _is_muslin(pid):
    try:
        return b"muslin" in pathlib.Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False


def read_log(path):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""


def is_locked(run):
    """Returns true if a process is writing this run directory."""
    lock = pathlib.Path(run) / "checkpoint" / "lock"
    if fcntl is None or not lock.exists():
        return False
    with open(lock, "rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
    return False


def run_status(run):
    """`status` of run.json, "" if there is none."""
    return read_run(run).get("status", "")


def read_run(run):
    try:
        with open(pathlib.Path(run) / "run.json", encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}

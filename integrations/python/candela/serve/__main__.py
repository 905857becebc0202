"""Pictures over HTTP, from the command line."""
from __future__ import annotations

import argparse
import re
import signal
import sys
import threading
from pathlib import Path
from typing import Any, Callable, Dict, List

from candela._errors import Error
from candela.serve._refusal import Refusal
from candela.serve._renderer import Job
from candela.serve._server import Limits, Server

_UNITS = {"": 1, "k": 10**3, "m": 10**6, "g": 10**9, "kib": 1 << 10, "mib": 1 << 20, "gib": 1 << 30}


def _size(text: str) -> int:
    found = re.fullmatch(r"(\d+(?:\.\d+)?)([kmg]?(?:ib)?)b?", text.lower())
    if not found or found[2] not in _UNITS or float(found[1]) <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 500M or 4GiB")
    return int(float(found[1]) * _UNITS[found[2]])


def _whole(least: int, most: int, what: str) -> Callable[[str], int]:
    def read(text: str) -> int:
        if not text.isascii() or not text.isdigit() or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"{text!r} is no {what} from {least} to {most}")
        return int(text)
    return read


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"{text!r} is no time above 0 [s]")
    return value


def _folder(text: str) -> Path:
    if not Path(text).is_dir():
        raise argparse.ArgumentTypeError(f"there is no folder {text!r}")
    return Path(text)


def _arguments() -> argparse.Namespace:
    limits = Limits()
    parser = argparse.ArgumentParser(prog="python -m candela.serve", allow_abbrev=False, description=(
        "Answers POST /render with pictures, and GET /health and /metrics. docs/http.md describes the requests."))
    add = parser.add_argument
    add("--port", type=_whole(0, 65535, "port"), default=8080, help="0: any that is free (default: 8080)")
    add("--host", default="127.0.0.1", help="the address to listen at; anybody who reaches it may use the server "
        "(default: this machine alone, 127.0.0.1)")
    add("--root", type=_folder, help="requests may name scenes in this folder")
    add("--device", help="index or part of the name, as for candela render")
    add("--queue", type=_whole(0, 100000, "number"), default=limits.queue,
        help=f"how many requests may wait (default: {limits.queue})")
    add("--time-limit", type=_seconds, default=limits.seconds,
        help=f"seconds for a request, once it is its turn (default: {limits.seconds:g})")
    add("--memory-limit", type=_size, default=limits.memory_bytes,
        help="for scenes and pictures, such as 500M (default: 4GiB)")
    add("--max-body", type=_size, default=limits.body_bytes, help="of a request (default: 256MiB)")
    add("--scenes", type=_whole(1, 1000, "number"), default=limits.scenes,
        help=f"how many scenes stay loaded (default: {limits.scenes})")
    add("-q", "--quiet", action="store_true", help="no line for each request")
    return parser.parse_args()


def main() -> int:
    """The exit code, as of the command line."""
    arguments = _arguments()
    limits = Limits(arguments.queue, arguments.time_limit, arguments.max_body, arguments.memory_limit, arguments.scenes)
    options: List[str] = [] if arguments.device is None else ["--device", arguments.device]

    def log(line: str) -> None:
        if not arguments.quiet:
            print(line, file=sys.stderr, flush=True)
    try:
        server = Server((arguments.host, arguments.port), arguments.root, limits, options, log)
    except OSError as error:
        print(f"candela.serve: error: cannot listen at {arguments.host}:{arguments.port}: {error.strerror}; "
              "choose another --port or --host", file=sys.stderr)
        return 1
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: threading.Thread(target=server.shutdown).start())
    try:
        _try_device(server)
        host = f"[{arguments.host}]" if ":" in arguments.host else arguments.host
        print(f"candela.serve: http://{host}:{server.server_port}/render", flush=True)
        server.serve_forever(poll_interval=0.1)
    except (Error, Refusal) as error:
        print(f"candela.serve: error: {error}", file=sys.stderr)
        return error.code if isinstance(error, Error) else 3
    finally:
        server.close()
    return 0


def _try_device(server: Server) -> None:
    """Raises an error if there is no device to render with."""
    devices: List[Dict[str, Any]] = []
    tried = Job(lambda renderer: devices.extend(renderer.call("devices", {})["devices"]))
    server.renderer.submit(tried)
    tried.done.wait()
    if tried.error is not None:
        raise tried.error
    if not any(device["usable"] for device in devices):
        raise Error("there is no Vulkan device that can be used; install a driver, such as the package "
                    "mesa-vulkan-drivers of Debian, or by pip candela-lavapipe", "no_device", 3)


sys.exit(main())

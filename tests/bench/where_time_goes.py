#!/usr/bin/env python3
"""Shows where a kernel's time goes on software Vulkan: samples a rendering with perf, takes the machine code that the
driver made out of the process, and prints its basic blocks by their share of the samples, with the instructions of the
largest to read: a block full of vcvtdq2ps decodes boxes, one with vdivps tests triangles, a short one that ends in ret
fetches texels. Needs Debian's packages linux-perf and binutils, and the right to read another process, as root has.

usage: where_time_goes.py [--seconds S] [--listing FILE] CANDELA SCENE [OPTION...]
e.g. where_time_goes.py build/release/candela scenes/cornell-box.json --spp 1000 --max-depth 5
"""
import argparse
import bisect
import re
import subprocess
import tempfile
import time
from pathlib import Path

COMPILED = 3.0  # Seconds after which kernels are compiled and paths are traced.
INSTRUCTION = re.compile(r"\s*([0-9a-f]+):\s+(.*)")
JUMP = re.compile(r"j\w+\s+(0x[0-9a-f]+)")


def generated_code(pid):
    """Start and bytes of each executable region of memory that no file backs."""
    regions = []
    with open(f"/proc/{pid}/maps", encoding="ascii") as maps, open(f"/proc/{pid}/mem", "rb") as memory:
        for fields in (line.split() for line in maps):
            if "x" not in fields[1] or len(fields) > 5:
                continue
            start, end = (int(limit, 16) for limit in fields[0].split("-"))
            memory.seek(start)
            regions.append((start, memory.read(end - start)))
    return regions


def sampled(command, seconds, folder):
    """Runs the command for a while; returns the addresses of all samples, sorted, and the generated code."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        time.sleep(COMPILED)
        data = str(Path(folder, "perf.data"))
        subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-F", "4000", "-p", str(process.pid), "-o", data,
                        "--", "sleep", str(seconds)], check=True)
        regions = generated_code(process.pid)
        process.kill()
    script = subprocess.run(["perf", "script", "-i", data, "-F", "ip"], check=True, capture_output=True, text=True)
    return sorted(int(word, 16) for word in script.stdout.split()), regions


def disassembled(start, code, folder):
    """Address and text of each instruction."""
    path = Path(folder, "code")
    path.write_bytes(code)
    listing = subprocess.run(["objdump", "-D", "-b", "binary", "-m", "i386:x86-64", "--no-show-raw-insn",
                              f"--adjust-vma={start:#x}", str(path)], check=True, capture_output=True, text=True)
    found = [INSTRUCTION.match(line) for line in listing.stdout.splitlines()]
    return [(int(m[1], 16), m[2]) for m in found if m]


def basic_blocks(instructions):
    targets = {int(m[1], 16) for m in (JUMP.match(text) for _, text in instructions) if m}
    blocks, block = [], []
    for address, text in instructions:
        if address in targets and block:
            blocks.append(block)
            block = []
        block.append((address, text))
        if text.startswith(("j", "ret")):
            blocks.append(block)
            block = []
    return blocks + [block] if block else blocks


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--listing", type=Path, help="writes all blocks with the share of each instruction")
    parser.add_argument("candela")
    parser.add_argument("scene")
    arguments, options = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as folder:
        command = [arguments.candela, "render", arguments.scene, "-o", str(Path(folder, "out.png")), "--quiet", *options]
        samples, regions = sampled(command, arguments.seconds, folder)

        def fraction(first, last):
            return 100.0 * (bisect.bisect(samples, last) - bisect.bisect_left(samples, first)) / len(samples)

        blocks = [block for start, code in regions if fraction(start, start + len(code)) > 1.0
                  for block in basic_blocks(disassembled(start, code, folder))]
    blocks.sort(key=lambda block: -fraction(block[0][0], block[-1][0]))
    print(f"{len(samples)} samples\n  share  instructions")
    for block in blocks[:20]:
        print(f"{fraction(block[0][0], block[-1][0]):6.2f} % {len(block):8d}  {block[0][0]:x} .. {block[-1][1]}")
    if arguments.listing:
        arguments.listing.write_text("".join(
            f"\nblock {block[0][0]:x}, {fraction(block[0][0], block[-1][0]):.2f} %\n"
            + "".join(f"{fraction(address, address):6.2f} {address:x}: {text}\n" for address, text in block)
            for block in blocks), encoding="utf-8")


if __name__ == "__main__":
    main()

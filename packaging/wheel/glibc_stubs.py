#!/usr/bin/env python3
"""glibc_stubs.py VERSION FOLDER: libraries to link with instead of this system's glibc, which offer only what
glibc VERSION has, so that programs linked with them run with that glibc and every later one.

For each library of glibc here, FOLDER gets an empty library of the same name with the same symbols, each in its
newest version that is not newer than VERSION. Symbols that moved between the libraries of glibc since then are in the
library where they are now: programs must be linked with libpthread, libdl and librt too, where they were.
"""

import pathlib
import re
import subprocess
import sys

LIBRARIES = ("libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2")
SYMBOL = re.compile(
    r"^\s*\d+: \w+ +(?P<size>\d+|0x\w+) +(?P<type>FUNC|IFUNC|OBJECT) +(?:GLOBAL|WEAK|UNIQUE) +DEFAULT +(?!UND)\w+ "
    r"(?P<name>\w+)@@?GLIBC_(?P<version>[0-9.]+)$"
)


def number(version):
    return tuple(int(part) for part in version.split("."))


def symbols(library, newest):
    """Name to (version, type, size)."""
    listing = subprocess.run(
        ["readelf", "-W", "--dyn-syms", library], check=True, capture_output=True, text=True
    ).stdout
    found = {}
    for line in listing.splitlines():
        match = SYMBOL.match(line)
        if match is None or number(match["version"]) > newest:
            continue
        if match["name"] not in found or number(match["version"]) > number(found[match["name"]][0]):
            found[match["name"]] = (match["version"], match["type"], int(match["size"], 0))
    return found


def write_stub(library, newest, folder):
    found = symbols(library, newest)
    lines = [".text"]
    for name, (_, kind, _) in found.items():
        if kind != "OBJECT":
            lines += [f".globl {name}", f".type {name}, @function", f"{name}: ret"]
    lines.append(".bss")
    for name, (_, kind, size) in found.items():
        if kind == "OBJECT":
            lines += [".balign 32", f".globl {name}", f".type {name}, @object", f".size {name}, {size}"]
            lines += [f"{name}: .zero {max(size, 1)}"]
    lines += ['.section .note.GNU-stack,"",@progbits', ""]
    nodes = []
    for version in sorted({entry[0] for entry in found.values()}, key=number):
        names = "".join(f" {name};" for name, entry in found.items() if entry[0] == version)
        nodes.append(f"GLIBC_{version} {{ global:{names} }};\n")
    if nodes:  # at last, so that it matches no name of the others
        nodes.append("GLIBC_STUB { local: *; };\n")
    name = pathlib.Path(library).name
    assembly, script = folder / f"{name}.s", folder / f"{name}.map"
    assembly.write_text("\n".join(lines))
    script.write_text("".join(nodes))
    versions = [f"-Wl,--version-script={script}"] if nodes else []
    subprocess.run(
        ["gcc", "-shared", "-nostdlib", f"-Wl,-soname,{name}", *versions, "-o", folder / name, assembly], check=True
    )


def main():
    newest, folder = number(sys.argv[1]), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    paths = {}
    for library in LIBRARIES:
        found = subprocess.run(
            ["gcc", f"-print-file-name={library}"], check=True, capture_output=True, text=True
        ).stdout.strip()
        write_stub(found, newest, folder)
        paths[library] = folder / library


if __name__ == "__main__":
    main()

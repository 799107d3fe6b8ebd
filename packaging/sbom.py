#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes which libraries the wheels and the programs contain, as CycloneDX, and validates that.

usage: sbom.py VERSION OUTPUT SOURCES NAME…     SOURCES is the folder of Debian's source packages, NAMEs those that are inside

It runs in the environment that builds wheels, whose zig and nanobind it names. The date is SOURCE_DATE_EPOCH.
"""
import datetime
import importlib.metadata
import os
import pathlib
import re
import subprocess
import sys
import uuid

from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from packageurl import PackageURL

# The licences of Debian's source packages, and of its packages of headers.
LICENCES = {
    "imath": "BSD-3-Clause", "libdeflate": "MIT", "libjpeg-turbo": "IJG AND BSD-3-Clause AND Zlib",
    "libpng1.6": "libpng-2.0", "meshoptimizer": "MIT", "muparser": "BSD-2-Clause",
    "openexr": "BSD-3-Clause", "zlib": "Zlib"}
HEADERS = {"libhwy-dev": "Apache-2.0", "nlohmann-json3-dev": "MIT"}
PROGRAM_HEADERS = {"libcli11-dev": "BSD-3-Clause"}


def component(name, version, licence, purl, kind=ComponentType.LIBRARY):
    return Component(name=name, version=version, licenses=[LicenseExpression(licence)], purl=purl, bom_ref=f"{name}@{version}", type=kind)


def debian(name, version, licence, **qualifiers):
    return component(name, version, licence, PackageURL("deb", "debian", name, version, {"distro": "bookworm", **qualifiers}))


def of_sources(folder, names):
    for name in names:
        file, = pathlib.Path(folder).glob(f"{name}_*.dsc")
        version = re.search(r"^Version: (\S+)", file.read_text(), re.M).group(1)
        yield debian(name, version, LICENCES[name], arch="source")


def of_headers(packages):
    for name, licence in packages.items():
        version = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", name], check=True, capture_output=True, text=True).stdout
        yield debian(name, version, licence, arch="all" if name.startswith("nlohmann") else "amd64")


def python(name, licence):
    version = importlib.metadata.version(name)
    return component(name, version, licence, PackageURL("pypi", None, name, version))


def inside(file, pattern):
    """The numbers that the pattern finds in a file of an installed package."""
    distribution, _, path = file.partition("/")
    text = pathlib.Path(importlib.metadata.distribution(distribution).locate_file(f"{distribution}/{path}")).read_text()
    return re.findall(pattern, text)


def bill(version, sources, names):
    zig = python("ziglang", "MIT")  # the build's own functions, compiler_rt, are zig's
    llvm = inside("ziglang/lib/libcxx/include/__config", r"define _LIBCPP_VERSION (\d\d)(\d\d)(\d\d)")[0]
    cxx = component("libc++", ".".join(str(int(number)) for number in llvm), "Apache-2.0 WITH LLVM-exception",
                    PackageURL("github", "llvm", "llvm-project", "llvmorg-" + ".".join(str(int(number)) for number in llvm)))
    musl, = inside("ziglang/lib/libc/musl/src/internal/version.h", r'VERSION "(.*)"')
    robin_map = ".".join(inside("nanobind/ext/robin_map/include/tsl/robin_growth_policy.h", r"define TSL_RH_VERSION_\w+ (\d+)"))
    both = [*of_sources(sources, names), *of_headers(HEADERS), cxx, zig,
            component("DejaVu Sans", "2.37", "Bitstream-Vera", None, ComponentType.DATA),
            component("colour maps", version, "Apache-2.0 AND CC0-1.0", None, ComponentType.DATA)]
    wheels = [python("nanobind", "BSD-3-Clause"),
              component("robin-map", robin_map, "MIT", PackageURL("github", "tessil", "robin-map", f"v{robin_map}"))]
    programs = [*of_headers(PROGRAM_HEADERS), component("musl", musl, "MIT", PackageURL("generic", None, "musl", musl))]

    def of_rastrum(name, kind):
        return component(name, version, "BSD-3-Clause", None, kind)

    whole = of_rastrum("rastrum", ComponentType.LIBRARY)
    wheel, program = of_rastrum("rastrum's wheels", ComponentType.LIBRARY), of_rastrum("rastrum's programs", ComponentType.APPLICATION)
    made = Bom(components=[wheel, program, *both, *wheels, *programs])
    made.metadata.component = whole
    made.metadata.timestamp = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
    made.register_dependency(whole, [wheel, program])
    made.register_dependency(wheel, [*both, *wheels])
    made.register_dependency(program, [*both, *programs])
    made.serial_number = uuid.uuid5(uuid.NAMESPACE_URL, " ".join(sorted(str(part.bom_ref) for part in made.components)))
    return made


def main():
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    version, output, sources, *names = sys.argv[1:]
    text = JsonV1Dot6(bill(version, sources, names)).output_as_string(indent=2)
    problem = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if problem:
        raise SystemExit(f"sbom.py: {problem}")
    pathlib.Path(output).write_text(text + "\n")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""What the package is made of: a software bill of materials, SPDX 2.3 as JSON.

    deploy/sbom.py PROGRAM VERSION

In: the program, the lists of Debian packages it is built from, the page's lock file. Out: JSON on standard output: the libraries it is linked with and
those that are compiled in, by the version that is installed here, and the page's own npm packages. Times come from SOURCE_DATE_EPOCH.
"""
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[1]


def run(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def linked(program):
    """Debian packages of the shared libraries that the program loads."""
    found = set()
    for path in re.findall(r"=> (/\S+)", run("ldd", program)):
        for candidate in (path, os.path.realpath(path), path.removeprefix("/usr"), "/usr" + path):
            owner = run("dpkg-query", "--search", candidate).split(":")[0].strip()
            if owner:
                found.add(owner)
                break
    return found


def compiled_in():
    """Packages of headers and static parts: what is built with, but for the tools."""
    names = [l.strip() for l in (TOP / "deploy/packages/build.txt").read_text().splitlines()]
    return {n for n in names if n.startswith("lib") and n.endswith("-dev") and not n.startswith("libclang")}


def debian(name, kind):
    version, source, licence = (run("dpkg-query", "--show", "--showformat=${Version}\n${source:Package}\n", name) + "\n\n").split("\n")[:2] + [""]
    return {"SPDXID": "SPDXRef-deb-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION", "comment": f"{kind}; source package {source}",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": f"pkg:deb/debian/{name}@{version}"}]}


def page_packages():
    lock = json.loads((TOP / "web/package-lock.json").read_text())
    for path, p in sorted(lock["packages"].items()):
        if path and not p.get("dev") and not p.get("devOptional") and not p.get("optional"):
            name = path.split("node_modules/")[-1]
            yield {"SPDXID": "SPDXRef-npm-" + re.sub(r"[^A-Za-z0-9.-]", "-", name), "name": name, "versionInfo": p["version"], "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
                   "licenseConcluded": "NOASSERTION", "licenseDeclared": p.get("license", "NOASSERTION"), "copyrightText": "NOASSERTION", "comment": "in the page",
                   "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": f"pkg:npm/{name}@{p['version']}"}]}


def main(program, version):
    digest = hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest()
    when = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")), datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    itself = {"SPDXID": "SPDXRef-axisgate", "name": "axisgate", "versionInfo": version, "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "Apache-2.0",
              "licenseDeclared": "Apache-2.0", "copyrightText": "axisgate developers", "checksums": [{"algorithm": "SHA256", "checksumValue": digest}]}
    parts = [debian(n, "linked at run time") for n in sorted(linked(program))] + [debian(n, "compiled in") for n in sorted(compiled_in())] + list(page_packages())
    document = {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"axisgate-{version}", "documentNamespace": f"urn:axisgate:sbom:{version}:{digest}",
                "creationInfo": {"created": when, "creators": ["Tool: deploy/sbom.py"]}, "packages": [itself, *parts],
                "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-axisgate"}]
                + [{"spdxElementId": "SPDXRef-axisgate", "relationshipType": "DEPENDS_ON", "relatedSpdxElement": p["SPDXID"]} for p in parts]}
    json.dump(document, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main(*sys.argv[1:])

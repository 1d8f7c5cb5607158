#!/usr/bin/env python3
"""Man pages and shell completion, made of what the program says of itself, so that they never say anything else.

    deploy/man.py PROGRAM CONFIGURATION FOLDER

In: `PROGRAM --help` and that of its subcommands; the configuration file with its comments. Out: axisgate.1, axisgate.toml.5 and
completion/axisgate in FOLDER. Never the date of the day: the same program gives the same pages.
"""
import pathlib
import re
import subprocess
import sys


def said(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=True).stdout


def roff(text):
    """Plain text as roff reads it: no escape and no request by accident."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def subcommands(program):
    text = said(program, "--help")
    part = text[text.index("Subcommands:"):]
    return re.findall(r"^  (\S+)\s+(.*)$", part, flags=re.M)


def options(program, command):
    text = said(program, command, "--help").replace(str(program), "axisgate")
    usage = re.search(r"^Usage: (.*)$", text, flags=re.M)
    return usage.group(1) if usage else f"axisgate {command}", re.findall(r"^  (-\S.*?)(?:  +| (?=[a-z][^=]*$))(.*)$", text, flags=re.M), text


def program_page(program, version):
    lines = [f'.TH AXISGATE 1 "" "axisgate {roff(version)}" "User Commands"', ".SH NAME", "axisgate \\- fieldbus gateway for motor drives", ".SH SYNOPSIS", ".B axisgate",
             ".I SUBCOMMAND", "[\\fIOPTION\\fR...]", ".SH DESCRIPTION", roff(said(program, "--help").splitlines()[0]) + ".",
             "The configuration of a host is in", ".BR axisgate.toml (5);", "the handbook is in", ".IR /usr/share/doc/axisgate/handbook ,",
             "and the gateway serves it at", ".IR /help .", ".SH SUBCOMMANDS"]
    for name, text in subcommands(program):
        lines += [".SS " + roff(name), roff(text[:1].upper() + text[1:]) + "."]
        if name not in ("help", "version"):
            lines += [".PP", ".nf", roff(options(program, name)[2].strip()), ".fi"]
    lines += [".SH FILES", ".TP", ".I /etc/axisgate/axisgate.toml", "the configuration of this host", ".TP", ".I /var/lib/axisgate", "the database: site, parameters, users, events",
              ".SH EXIT STATUS", "0: it ended as it was asked to; 1: it failed; 2: wrong use, or a faulty configuration.", ".SH SEE ALSO", ".BR axisgate.toml (5)"]
    return "\n".join(lines) + "\n"


def configuration_page(path, version):
    lines = [f'.TH AXISGATE.TOML 5 "" "axisgate {roff(version)}" "File Formats"', ".SH NAME", "axisgate.toml \\- configuration of a host that runs axisgate", ".SH DESCRIPTION"]
    for text in pathlib.Path(path).read_text().splitlines():
        section = re.fullmatch(r"\[(\w+)\]", text)
        key = re.fullmatch(r"#?(\w+) = (.*?)\s*(?:#\s*(.*))?", text)
        if section:
            lines += [".SH " + section.group(1).upper(), f"Section \\fB[{section.group(1)}]\\fR."]
        elif key and not text.startswith("# "):
            lines += [".TP", f"\\fB{key.group(1)}\\fR = {roff(key.group(2))}", roff(key.group(3) or "")]
        elif text.startswith("# "):
            lines.append(roff(text[2:]))
    lines += [".SH ENVIRONMENT", "\\fBAXISGATE_SECTION_KEY\\fR sets a key, and", ".B \\-\\-set", "on the command line goes before both.", ".SH SEE ALSO", ".BR axisgate (1)"]
    return "\n".join(line for line in lines if line.strip()) + "\n"


def completion(program):
    names = [name for name, _ in subcommands(program)]
    cases = []
    for name in names:
        flags = sorted(set(re.findall(r"(?<![\w-])--[a-z][\w-]*", said(program, name, "--help")))) if name not in ("help", "version") else []
        cases.append(f"        {name}) words='{' '.join(flags)}' ;;")
    return "\n".join(["# Completion of axisgate for bash: subcommands, their options, files behind options that take one.", "_axisgate() {",
                      "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words", "    COMPREPLY=()",
                      "    case $before in", "        --config | --site | --data) compopt -o default; return ;;", "    esac",
                      "    case ${COMP_WORDS[1]} in", *cases, f"        *) words='{' '.join(names)} --help --version' ;;", "    esac",
                      "    [ \"$COMP_CWORD\" -gt 1 ] || words='" + " ".join(names) + " --help --version'",
                      "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")", "}", "complete -F _axisgate axisgate"]) + "\n"


def main(program, configuration, folder):
    program = pathlib.Path(program).resolve()
    version = said(program, "--version").split()[-1]
    folder = pathlib.Path(folder)
    (folder / "axisgate.1").write_text(program_page(program, version))
    (folder / "axisgate.toml.5").write_text(configuration_page(configuration, version))
    (folder / "completion").mkdir(exist_ok=True)
    (folder / "completion/axisgate").write_text(completion(program))


if __name__ == "__main__":
    main(*sys.argv[1:])

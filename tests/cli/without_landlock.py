"""Runs a command as on a kernel without Landlock: a filter of system calls answers ENOSYS.

usage: without_landlock.py COMMAND [ARGUMENT ...]
"""

import ctypes
import os
import struct
import sys

SYS_LANDLOCK_CREATE_RULESET = 444  # on all machines
PR_SET_NO_NEW_PRIVS, PR_SET_SECCOMP, SECCOMP_MODE_FILTER = 38, 22, 2
LOAD, JUMP_IF_EQUAL, RETURN = 0x20, 0x15, 0x06  # BPF instructions, linux/bpf_common.h
ALLOW, ENOSYS = 0x7FFF0000, 0x00050000 | 38


def filter_of_landlock():
    instructions = [
        (LOAD, 0, 0, 0),  # the number of the system call
        (JUMP_IF_EQUAL, 0, 1, SYS_LANDLOCK_CREATE_RULESET),
        (RETURN, 0, 0, ENOSYS),
        (RETURN, 0, 0, ALLOW),
    ]
    return b"".join(struct.pack("=HBBI", *each) for each in instructions), len(instructions)


def main():
    code, count = filter_of_landlock()
    text = ctypes.create_string_buffer(code)
    program = ctypes.create_string_buffer(struct.pack("=Hxxxxxxq", count, ctypes.addressof(text)))
    libc = ctypes.CDLL(None, use_errno=True)
    libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0)
    if libc.prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, program, 0, 0) != 0:
        sys.exit(f"cannot set the filter: {os.strerror(ctypes.get_errno())}")
    os.execvp(sys.argv[1], sys.argv[1:])


if __name__ == "__main__":
    main()

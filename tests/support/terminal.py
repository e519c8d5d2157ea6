"""terminal.py COMMAND ...: the command with a terminal of its own, at whose end of input it is; what it prints, and its status."""
import os
import pty
import sys

pid, terminal = pty.fork()
if pid == 0:
    os.execvp(sys.argv[1], sys.argv[1:])
os.write(terminal, b"\x04")
while True:
    try:
        data = os.read(terminal, 65536)
    except OSError:  # nobody has it open any more
        break
    os.write(1, data)
status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
sys.exit(status if status >= 0 else 128 - status)

"""Python without its start: importing h5py and numpy takes 0.1 s of the processor, of which a test may need a hundred.

python.py SOCKET ARGUMENT ...   python3 ARGUMENT ..., in a copy of a process that has imported them and waits at SOCKET;
                                it is started, and ends when the process PID of --serve or SOCKET is gone
python.py --serve SOCKET PID    that process
"""
import _socket
import marshal
import os
import sys


def connect(path):
    s = _socket.socket(_socket.AF_UNIX, _socket.SOCK_STREAM)
    try:
        s.connect(path)
        return s
    except OSError:
        return None


def receive(s):
    parts = []
    while part := s.recv(1 << 16):
        parts.append(part)
    return b"".join(parts)


def ask(path, arguments):
    """The status of python3 ARGUMENTS, with our files, directory and environment."""
    s = connect(path)
    if s is None:
        os.spawnv(os.P_WAIT, sys.executable, [sys.executable, __file__, "--serve", path, os.environ["NSD_TEST"]])
        s = connect(path)
    files = os.open(".", os.O_RDONLY), *[os.open("/dev/null", os.O_RDWR) if is_closed(fd) else fd for fd in range(3)]
    s.sendmsg([b"x"], [(_socket.SOL_SOCKET, _socket.SCM_RIGHTS, b"".join(fd.to_bytes(4, sys.byteorder) for fd in files))])
    s.sendall(marshal.dumps((arguments, dict(os.environ))))
    s.shutdown(_socket.SHUT_WR)
    said = s.recv(1)  # not to the end: processes that it leaves behind have s, too
    return said[0] if said else 70  # it was killed


def is_closed(fd):
    try:
        os.fstat(fd)
    except OSError:
        return True
    return False


def run(arguments):
    """As python3 does: -c TEXT, - or FILE."""
    main = sys.modules["__main__"] = type(sys)("__main__")
    first = arguments[0]
    if first == "-c":
        text, name, sys.path[0] = arguments[1], "<string>", ""
        arguments = ["-c", *arguments[2:]]
    elif first == "-":
        text, name, sys.path[0] = sys.stdin.read(), "<stdin>", ""
    else:
        with open(first, encoding="utf-8") as f:
            text, name, sys.path[0] = f.read(), first, os.path.dirname(os.path.abspath(first))
        main.__file__ = first
    sys.path[1:1] = [p for p in os.environ.get("PYTHONPATH", "").split(":") if p]
    sys.argv = arguments
    try:
        exec(compile(text, name, "exec"), vars(main))
    except SystemExit as e:
        if e.code is None or isinstance(e.code, int):
            return e.code or 0
        print(e.code, file=sys.stderr)
        return 1
    except BaseException:
        sys.excepthook(*sys.exc_info())
        return 1
    return 0


def answer(s, status):
    """What the end of Python would do to files, without freeing all that has been copied."""
    import atexit
    import threading
    threading._shutdown()
    atexit._run_exitfuncs()
    h5py = sys.modules.get("h5py")
    for file in h5py.h5f.get_obj_ids(types=h5py.h5f.OBJ_FILE) if h5py else ():
        h5py.File(file).close()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError:
        status = status or 120
    s.send(bytes([status & 255]))
    os._exit(0)


def accept(s):
    """The files, directory, arguments and environment of who asks."""
    _, said, _, _ = s.recvmsg(1, 64)
    data = said[0][2]
    files = [int.from_bytes(data[k:k + 4], sys.byteorder) for k in range(0, 16, 4)]
    asked = marshal.loads(receive(s))
    os.fchdir(files[0])
    for k in range(3):
        os.dup2(files[k + 1], k)
    for fd in files:
        os.close(fd)
    return s, *asked


def serve(path, of):
    mine = _socket.socket(_socket.AF_UNIX, _socket.SOCK_STREAM)
    own = f"{path}.{os.getpid()}"
    mine.bind(own)
    mine.listen(64)
    os.environ["OPENBLAS_NUM_THREADS"] = "1"  # threads are not copied
    import gc
    for module in "h5py", "numpy", "json", "subprocess", "warnings", "threading":
        try:
            __import__(module)
        except ImportError:
            pass  # who needs it says so
    gc.freeze()
    os.rename(own, path)  # of two that are started at a time, the last one is asked
    inode = os.stat(path).st_ino
    if os.fork():
        os._exit(0)  # who started it goes on
    os.setsid()
    null = os.open("/dev/null", os.O_RDWR)
    for fd in range(3):
        os.dup2(null, fd)
    mine.settimeout(1)
    while True:
        try:
            os.kill(of, 0)
            if os.stat(path).st_ino != inode:
                return None
        except OSError:
            return None
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            pass
        try:
            fd, _ = mine._accept()
        except OSError:
            continue
        s = _socket.socket(fileno=fd)
        s.settimeout(None)
        if os.fork() == 0:
            mine.close()
            return accept(s)
        s.close()


if sys.argv[1] != "--serve":
    sys.exit(ask(sys.argv[1], sys.argv[2:]))
asked = serve(sys.argv[2], int(sys.argv[3]))
if asked:
    os.environ.clear()
    os.environ.update(asked[2])
    answer(asked[0], run(asked[1]))

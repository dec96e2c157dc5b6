"""Runs nullcone-view for tests: a small dataset, a server on the loopback, requests as bytes."""
import json
import os
import pathlib
import signal
import socket
import subprocess
import tempfile

VIEWER = "0123456789abcdef"


class Server:
    """nullcone-view with a small scene of the Goedel universe; ends with the `with` block."""

    def __init__(self, tools, source, *options, scene=None):
        self.folder = tempfile.TemporaryDirectory(prefix="nullcone-test-")
        self.place = pathlib.Path(self.folder.name)
        if scene is None:
            scene = json.loads((source / "scenes/goedel_earth.json").read_text())
            scene["camera"]["resolution"] = [264, 30]
        (self.place / "scene.json").write_text(json.dumps(scene))
        self.data = self.place / "data.exr"
        subprocess.run([tools / "nullcone-trace", self.place / "scene.json", "-o", self.data, "-q"], check=True)
        (self.place / "tmp").mkdir()
        self.process = subprocess.Popen([tools / "nullcone-view", self.data, *options], stdout=subprocess.PIPE, text=True,
                                        cwd=self.place, env={**os.environ, "TMPDIR": str(self.place / "tmp")})
        self.address = self.process.stdout.readline().strip()
        self.port = int(self.address.split(":")[-1].split("/")[0])
        self.base = "/" + self.address.split("/", 3)[3]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.stop()
        self.folder.cleanup()

    def stop(self):
        """Ends the server as Ctrl-C does; its exit status."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=20)

    def connect(self, timeout=15):
        return socket.create_connection(("127.0.0.1", self.port), timeout=timeout)

    def raw(self, data, timeout=15):
        """Sends bytes; (status, body) of what comes back, or (None, b"") when the peer just closes."""
        with self.connect(timeout) as peer:
            try:
                peer.sendall(data)
            except OSError:
                pass  # refused before all of it was sent: the answer may be there
            return read_answer(peer)[:2]

    def request(self, method, path, body=b"", viewer=VIEWER, headers=(), host=None, timeout=15):
        """(status, body) of one request to `path` below the page's address."""
        if isinstance(body, (dict, list)):
            body = json.dumps(body).encode()
        lines = [f"{method} {self.base}{path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{self.port}'}",
                 f"X-Nullcone-Viewer: {viewer}", f"Content-Length: {len(body)}", "Connection: close", *headers]
        return self.raw("\r\n".join(lines).encode() + b"\r\n\r\n" + body, timeout)


def read_answer(peer):
    """(status, body, rest) of the next answer on a connection."""
    data = b""
    while b"\r\n\r\n" not in data:
        try:
            more = peer.recv(65536)
        except ConnectionError:
            more = b""
        if not more:
            return (int(data.split()[1]), b"", b"") if data.startswith(b"HTTP/1.1 ") else (None, data, b"")
        data += more
    head, _, body = data.partition(b"\r\n\r\n")
    length = next((int(line.split(b":")[1]) for line in head.split(b"\r\n") if line.lower().startswith(b"content-length")), 0)
    while len(body) < length:
        more = peer.recv(1 << 20)
        if not more:
            break
        body += more
    return int(head.split()[1]), body[:length], body[length:]

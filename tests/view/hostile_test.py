#!/usr/bin/env python3
"""Strangers at the door of nullcone-view: each gets a 4xx, nothing is read or written, and the server goes on.

Usage: hostile_test.py TOOLS_DIR SOURCE_DIR
"""
import json
import os
import pathlib
import random
import resource
import sys
import threading
import time

from serve import Server, read_answer

TOOLS, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
SLOW = 10 if os.environ.get("NULLCONE_SANITIZED") else 1
EARTH = pathlib.Path("/usr/share/xplanet/images/earth.jpg").read_bytes()
faults = []
checks = 0


def check(condition, what):
    global checks
    checks += 1
    if not condition:
        faults.append(what)
        print("FAULT:", what)


def refused(answer, what, statuses=range(400, 500)):
    check(answer[0] in statuses, f"{what}: {answer[0]} {answer[1][:120]}")


def alive(server, viewer="feedfeedfeedfeed", within=2.0):
    """An honest page still gets its frame, soon."""
    start = time.monotonic()
    status, body = server.request("POST", "api/frame?scale=1&format=raw", {}, viewer)
    check(status == 200 and len(body) == 4 * 264 * 30, f"an honest viewer got {status} {body[:80]}")
    took = time.monotonic() - start
    check(took < within * SLOW, f"an honest viewer waited {took:.2f} s")


def wrong_paths(server):
    for path in ["../../etc/passwd", "..%2f..%2fetc%2fpasswd", "%2e%2e/etc/passwd", "/etc/passwd", "api/../../etc/passwd",
                 "api/state/../../data.exr", "data.exr", "scene.json", "api/nothing", "api/", "index.html/", "\\..\\x",
                 "file:///etc/passwd", "index.html%00.js", "//localhost/x"]:
        refused(server.request("GET", path), path)
    for method in ["PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "PROPFIND", "BREW"]:
        refused(server.request(method, "api/state"), method)
    refused(server.request("GET", "api/frame"), "GET of a frame")
    refused(server.request("POST", "api/state", {}), "POST of the state")


def wrong_queries(server):
    for query in ["scale=0", "scale=3", "scale=-1", "scale=1e9", "scale=99999999999999999999", "scale=nan", "scale=", "scale",
                  "scale=1&scale=2", "data=1", "data=-1", "data=live", "data=../x", "frame=-1", "frame=1.5", "format=bmp",
                  "nonsense=1", "%", "%zz=1", "=", "&&", "scale=%31%00"]:
        refused(server.request("POST", "api/frame?" + query, {}), query)
    for query in ["x=1", "x=-1&y=0", "x=264&y=0", "x=0&y=30", "x=1e3&y=0", "x=2147483648&y=0", "x=NaN&y=0",
                  "x=0&y=0&width=0", "x=264&y=0&width=264", "x=0&y=30&height=30", "x=0&y=0&height=1e3", "x=0&y=0&width=99999999999"]:
        refused(server.request("POST", "api/pixel?" + query, {}), query)
    for path in ["api/histogram?object=moon", "api/histogram?object=earth&bins=0", "api/histogram?object=earth&bins=1e9",
                 "api/histogram?object=earth&channel=Z%27", "api/images?object=", "api/images", "api/channel?name=nothing",
                 "api/channel?name=shift&from=nan&to=1", "api/channel?name=shift&from=1", "api/channel?name=shift&from=2&to=1"]:
        refused(server.request("GET", path), path)


def wrong_bodies(server):
    nested = b"[" * 100_000 + b"]" * 100_000
    for body in [b"", b"{", b"[]", b"null", b"1", b"\xff\xfe", b"NaN", b'{"a":NaN}', b'{"effects":{"doppler":1e999}}', nested,
                 b'{"objects":{"earth":{"opacity":1e999}}}', b'{"effects":{},"effects":{}}', b"\x00" * 1000, b'{"x":"' + b"a" * 10_000 + b'"}',
                 b'{"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":-1}}}}',
                 b'{"objects":{"earth":{"texture":{"type":"image","file":"/etc/passwd"}}}}',
                 b'{"objects":{"earth":{"texture":{"type":"image","file":"../data.exr"}}}}',
                 b'{"objects":{"earth":{"spectrum":{"type":"tabulated","file":"/etc/passwd"}}}}',
                 b'{"sensor":{"file":"/proc/self/environ"}}']:
        for path in ["api/frame", "api/look", "api/pixel?x=0&y=0", "api/picture", "api/trace", "api/dataset"]:
            refused(server.request("POST", path, body), f"{path} {body[:60]}")
    for scene in [{"observer": {"event": [1e300, 0, 0, 0]}}, {"observer": {"velocity": [1, 0, 0]}}, {"observer": {"velocity": [0, None, 0]}},
                  {"camera": {"resolution": [100_000, 100_000]}}, {"camera": {"resolution": [0, 1]}}, {"metric": {"a": -1}}, {"metric": {"name": "x"}},
                  {"objects": {"moon": {}}}, {"objects": {"earth": {"radius": -1}}}, {"objects": {"earth": {"event": [1.438, 0, 0, 0]}}},
                  {"max_lookback": 1e300}, {"look": {}}, {"records": {"max_hits": 1000}}]:
        refused(server.request("POST", "api/trace", {"scene": scene, "look": {}}), f"trace {scene}")
    for name, body in [("x.png", b"no picture"), ("../../x.png", b""), ("x", b"\x89PNG\r\n\x1a\n" + bytes(100)), ("a" * 300, b"GIF89a")]:
        refused(server.request("POST", f"api/texture?name={name}", body), f"texture {name}")
    refused(server.request("POST", "api/look", b" " * 5_000_000), "a look of 5 MB", [413])


def wrong_http(server):
    host = f"Host: 127.0.0.1:{server.port}\r\n".encode()
    for data, what in [(b"\x16\x03\x01\x02\x00\x01\x00", "TLS"), (b"GET\r\n\r\n", "no path"), (b"\r\n" * 100 + b"x", "blank lines"), (os.urandom(2000), "noise"),
                       (b"GET / HTTP/1.1\r\n\r\n", "no host"), (b"GET / HTTP/1.1\r\n" + host + host + b"\r\n", "two hosts"),
                       (b"GET / HTTP/9.9\r\n" + host + b"\r\n", "a version"), (b"GET /" + b"a" * 8000 + b" HTTP/1.1\r\n" + host + b"\r\n", "a long path"),
                       (b"GET / HTTP/1.1\r\n" + host + b"X: " + b"a" * 100_000 + b"\r\n\r\n", "a long header"),
                       (b"GET / HTTP/1.1\r\n" + host + b"X: 1\r\n" * 20_000 + b"\r\n", "many headers"),
                       (b"GET http://evil.example/ HTTP/1.1\r\n" + host + b"\r\n", "a proxy's request")]:
        answer = server.raw(data)
        check(answer[0] is None or 400 <= answer[0] < 500, f"{what}: {answer[0]}")
    post = b"POST " + server.base.encode() + b"api/frame HTTP/1.1\r\n" + host + b"X-Nullcone-Viewer: 0123456789abcdef\r\n"
    for line in [b"Content-Length: -1", b"Content-Length: x", b"Content-Length: 99999999999999999999999", b"Content-Length: 1000000000000",
                 b"Content-Length: 2\r\nContent-Length: 3", b"Transfer-Encoding: chunked", b"Transfer-Encoding: chunked\r\nContent-Length: 2"]:
        refused(server.raw(post + line + b"\r\n\r\n{}"), line)
    refused(server.raw(post + b"\r\n"), "a POST without a body")
    for host, origin, site, status in [("evil.example", None, None, 421), (None, "http://evil.example", None, 403), (None, "null", None, 403),
                                       (None, None, "cross-site", 403)]:
        headers = ([f"Origin: {origin}"] if origin else []) + ([f"Sec-Fetch-Site: {site}"] if site else [])
        refused(server.request("POST", "api/frame", {}, host=host, headers=headers), f"{host} {origin} {site}", [status])
    refused(server.request("GET", "api/state", viewer="../../x"), "a viewer's name", [400])


def noise(server, count):
    """Honest requests with a few bytes changed."""
    chance = random.Random(7)
    honest = (f"POST {server.base}api/frame?data=0&scale=2 HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nX-Nullcone-Viewer: 0123456789abcdef\r\n"
              "Content-Length: 76\r\nConnection: close\r\n\r\n"
              '{"objects":{"earth":{"spectrum":{"type":"black_body","temperature_K":6000}}}}').encode()
    for _ in range(count):
        data = bytearray(honest)
        for _ in range(chance.randint(1, 4)):
            data[chance.randrange(len(data))] = chance.randrange(256)
        with server.connect(3) as peer:
            peer.sendall(data)
            peer.shutdown(1)
            status = read_answer(peer)[0]
        check(status is None or status < 500, f"{status} for {bytes(data)}")


def thousand_connections(server):
    """Silent ones, ones in the middle of a request, and ones that ask, all at once."""
    peers, statuses = [], []
    for i in range(1000):
        peer = server.connect()
        peers.append(peer)
        try:
            if i % 3 == 1:
                peer.sendall(b"POST /api/frame HTTP/1.1\r\nHost: local")
            if i % 3 == 2:
                peer.sendall(f"GET /api/nothing HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nX-Nullcone-Viewer: 0123456789abcdef\r\n\r\n".encode())
        except OSError:
            pass
    alive(server, within=5)
    for i, peer in enumerate(peers):
        peer.settimeout(0.2 if i % 3 != 2 else 5)
        try:
            statuses.append(read_answer(peer)[0])
        except TimeoutError:
            statuses.append("open")
        peer.close()
    told = [status for status in statuses if status not in ("open", None)]
    check(all(400 <= status < 500 for status in told), f"statuses {set(told)}")
    asked = [status for i, status in enumerate(statuses) if i % 3 == 2]
    check(sum(status is not None for status in asked) > 200, f"of those that asked {asked.count(None)} heard nothing")
    print("1000 connections:", {status: statuses.count(status) for status in set(statuses)})


def slow_and_vanished(server):
    trickling = [server.connect() for _ in range(50)]
    unread = []
    for i in range(20):
        peer = server.connect()
        peer.setsockopt(1, 8, 2048)  # SO_RCVBUF: what is sent stays with the server
        peer.sendall((f"POST {server.base}api/frame HTTP/1.1\r\nHost: localhost\r\nX-Nullcone-Viewer: {i % 3:016x}\r\nContent-Length: 2\r\n\r\n" + "{}").encode())
        unread.append(peer)
    for letter in b"GET /api/":
        for peer in trickling:
            peer.sendall(bytes([letter]))
        alive(server)
    for _ in range(50):
        with server.connect() as peer:
            peer.sendall(f"POST {server.base}api/frame HTTP/1.1\r\nHost: localhost\r\nX-Nullcone-Viewer: {1:016x}\r\nContent-Length: 2\r\n\r\n{{}}".encode())
    alive(server)
    for peer in trickling + unread:
        peer.close()


def many_viewers(server):
    """Honest pages side by side, each with a look and a scene of its own, and pictures of one another."""
    def one(number):
        viewer = f"{number:015x}a"
        for i in range(12):
            kelvin = 2000 + 100 * number + i
            look = {"objects": {"earth": {"spectrum": {"type": "black_body", "temperature_K": kelvin}}}}
            frames = [server.request("POST", f"api/frame?scale={scale}", look, viewer) for scale in (1, 2)]
            traced = server.request("POST", "api/trace?scale=2", {"scene": {"camera": {"azimuth_deg": 10 * number + i}}, "look": look}, viewer)
            others = [server.request("GET", path, viewer=viewer) for path in ("api/images?object=earth", "api/histogram?object=earth", "api/channel?name=t")]
            sent = (429,)
            while sent[0] == 429:  # two at a time
                sent = server.request("POST", f"api/texture?name=map{number}.jpg", EARTH + bytes([number, i]), viewer)
            for status, body in [*frames, traced, *others, sent]:
                check(status == 200, f"viewer {number}: {status} {body[:100]}")
            check(len(frames[0][1]) == 4 * 264 * 30, f"viewer {number}: a picture")
    threads = [threading.Thread(target=one, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def flood(server):
    statuses = []
    with server.connect() as peer:
        ask = f"GET {server.base}api/state HTTP/1.1\r\nHost: localhost\r\nX-Nullcone-Viewer: {'f' * 16}\r\n\r\n".encode()
        for _ in range(2000):
            try:
                peer.sendall(ask)
                status, _, _ = read_answer(peer)
            except OSError:
                status = None
            if status is None:
                break
            statuses.append(status)
    check(429 in statuses or SLOW > 1, f"2000 requests as fast as they go: {set(statuses)}")
    crowd = [server.request("GET", "api/state", viewer=f"{i:016x}")[0] for i in range(100, 120)]
    check(429 in crowd, f"20 viewers: {crowd}")


def main():
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(max(soft, 4096), hard), hard))
    with Server(TOOLS, SOURCE, "--viewers", "6") as server:
        before = sorted(path.name for path in server.place.iterdir())
        alive(server)
        for attack in [wrong_paths, wrong_queries, wrong_bodies, wrong_http]:
            attack(server)
            time.sleep(1)  # rates are limited too
            alive(server)
        noise(server, int(os.environ.get("NULLCONE_NOISE", 300)) // SLOW)
        for attack in [thousand_connections, slow_and_vanished, flood]:
            attack(server)
            alive(server)
        check(server.stop() == 0, "the server did not end as it should")
        check(sorted(path.name for path in server.place.iterdir()) == before, "files were written")
        check(not list((server.place / "tmp").iterdir()), "temporary files were left")
    with Server(TOOLS, SOURCE) as server:
        many_viewers(server)
    with Server(TOOLS, SOURCE, "--token") as server:
        check(len(server.base) == 34, f"a token of 32 digits: {server.base}")
        alive(server)
        for path in [b"/", b"/api/state", b"/" + b"0" * 32 + b"/"]:
            refused(server.raw(b"GET " + path + b" HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"), path, [404])
    print(f"{checks} checks, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

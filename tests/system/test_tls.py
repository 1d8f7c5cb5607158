"""TLS of the HTTP door on the real program: Python's ssl is the client.

In: the real program, certificates of our own making and of openssl's. Out: judgements.
"""
import base64
import http.client
import json
import os
import socket
import ssl
import stat
import subprocess
import time

from harness import DEMO, Gateway, Process, run

OWN = ("--set", "http.tls=self_signed")


class SecureGateway(Gateway):
    def __init__(self, folder, *more):
        (folder / "site.json").write_text(json.dumps(DEMO))
        Process.__init__(self, "serve", "--data", str(folder / "data"), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=127.0.0.1:0",
                         "--site", str(folder / "site.json"), *more)
        self.port = int(self.word("https").rsplit(":", 1)[1])
        self.trust = ssl.create_default_context(cafile=str(folder / "data" / "http-cert.pem")) if more == OWN else None

    def connect(self):
        return http.client.HTTPSConnection("localhost", self.port, timeout=20, context=self.trust)

    def raw(self):
        s = socket.create_connection(("127.0.0.1", self.port), timeout=20)
        return s

    def ask(self, method, path, body=None, headers=None):
        c = self.connect()
        try:
            return ask(c, method, path, body, headers)
        finally:
            c.close()


def ask(c, method, path, body=None, headers=None):
    c.request(method, path, None if body is None else json.dumps(body), {"Content-Type": "application/json", **(headers or {})})
    r = c.getresponse()
    data = r.read()
    return r.status, json.loads(data) if "json" in r.getheader("Content-Type", "") else data, dict(r.getheaders())


def certificate(folder, name, *more):
    cert, key = folder / f"{name}.pem", folder / f"{name}.key"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", "/CN=localhost", "-addext",
                    "subjectAltName=DNS:localhost", "-keyout", str(key), "-out", str(cert), *(more or ("-days", "30"))], check=True, capture_output=True, timeout=30)
    return cert, key


def files(cert, key):
    return "--set", f"http.tls_cert={cert}", "--set", f"http.tls_key={key}"


def all_of(s):
    data = b""
    while part := s.recv(65536):
        data += part
    return data


def test_requests_over_tls_keep_their_connection(folder):
    with SecureGateway(folder, *OWN) as g:
        c = g.connect()
        s, about, head = ask(c, "GET", "/api/v1/about")
        assert s == 200 and {"name": "https", "address": f"127.0.0.1:{g.port}"} in about["doors"], about
        assert "Strict-Transport-Security" not in head, "a self-made certificate must stay one that a browser can make an exception for"
        was = c.sock
        for _ in range(5):
            s, body, _ = ask(c, "POST", "/api/v1/axes/feeder/commands?wait=10", {"command": "quick_stop"})
            assert s in (200, 202), (s, body)
            assert ask(c, "GET", "/api/v1/axes")[0] == 200
        assert c.sock is was, "one connection for all"
        assert c.sock.version() in ("TLSv1.2", "TLSv1.3")
        # Over several TLS records, in both directions.
        s, body, _ = ask(c, "PUT", "/api/v1/site", {"x": "y" * 300_000})
        assert s in (400, 422), (s, body)
        assert len(ask(c, "GET", "/api/v1/openapi.yaml")[1]) > 50_000
        c.close()
        # Two requests in one record: the second is deciphered already when the first is answered.
        with g.trust.wrap_socket(g.raw(), server_hostname="localhost") as s:
            s.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            assert all_of(s).count(b"HTTP/1.1 200") == 2
        old = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        old.check_hostname, old.verify_mode = False, ssl.CERT_NONE
        old.set_ciphers("ALL:@SECLEVEL=0")
        old.minimum_version = old.maximum_version = ssl.TLSVersion.TLSv1_1
        try:
            old.wrap_socket(g.raw())
            raise AssertionError("TLS 1.1 was taken")
        except (ssl.SSLError, ConnectionError):
            pass
        metrics = ask(g.connect(), "GET", "/metrics")[1].decode()
        assert "axisgate_http_tls_handshakes_failed_total 1\n" in metrics, metrics
        assert g.stop() == 0


def test_the_live_feed_over_tls(folder):
    with SecureGateway(folder, *OWN) as g:
        with g.trust.wrap_socket(g.raw(), server_hostname="localhost") as s:
            key = base64.b64encode(os.urandom(16)).decode()
            s.sendall((f"GET /api/v1/stream HTTP/1.1\r\nHost: localhost:{g.port}\r\nOrigin: https://localhost:{g.port}\r\nUpgrade: websocket\r\n"
                       f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
            head = b""
            while b"\r\n\r\n" not in head:
                head += s.recv(1)
            assert head.startswith(b"HTTP/1.1 101"), head

            def exact(n):
                data = b""
                while len(data) < n:
                    part = s.recv(n - len(data))
                    assert part, "the feed ended"
                    data += part
                return data

            def frame():
                first, size = exact(2)
                if size == 126:
                    size = int.from_bytes(exact(2), "big")
                elif size == 127:
                    size = int.from_bytes(exact(8), "big")
                return first & 15, exact(size)

            def send(opcode, payload):
                mask = os.urandom(4)
                size = bytes([0x80 | len(payload)]) if len(payload) < 126 else bytes([0x80 | 126]) + len(payload).to_bytes(2, "big")
                s.sendall(bytes([0x80 | opcode]) + size + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

            send(9, b"are you there")
            while (f := frame())[0] != 10:
                pass
            assert f[1] == b"are you there"
            send(8, (1000).to_bytes(2, "big"))
            while (f := frame())[0] != 8:
                pass
            assert f[1][:2] == (1000).to_bytes(2, "big")
            assert s.recv(1) == b"", "the end is said in TLS too"
        assert g.stop() == 0


def test_the_cookie_is_secure(folder):
    with SecureGateway(folder, *OWN) as g:
        s, body, head = g.ask("POST", "/api/v1/session/first", {"code": g.code, "user": "anna", "password": "correct-horse-9"})
        assert s == 200 and "Secure" in head["Set-Cookie"].split("; "), (body, head)


def test_plain_http_is_told_where_to_go(folder):
    with SecureGateway(folder, *OWN) as g:
        for text in (b"GET /api/v1/axes HTTP/1.1\r\nHost: localhost\r\n\r\n", b"\x00\x01\x02"):
            with g.raw() as s:
                s.sendall(text)
                answer = all_of(s)
                assert answer.startswith(b"HTTP/1.1 400") and b"https://" in answer and b"Connection: close" in answer, answer
        assert g.ask("GET", "/healthz")[0] == 200


def test_silent_handshakes_harm_nobody(folder):
    with SecureGateway(folder, *OWN, "--set", "limits.http_connections=16") as g:
        g.trust = ssl.create_default_context(cafile=str(folder / "data" / "http-cert.pem"))
        silent = [g.raw() for _ in range(30)]
        for i, s in enumerate(silent):
            try:
                s.sendall(b"\x16\x03\x01\x02\x00\x01"[:1 + i % 6])
            except ConnectionError:
                pass  # made room for another one already
        for _ in range(10):
            begun = time.monotonic()
            assert g.ask("GET", "/healthz")[0] == 200
            assert time.monotonic() - begun < 2
        # The bound in time: what is still open is cut 10 s after it came.
        last = silent[-1]
        begun = time.monotonic()
        try:
            assert last.recv(1) == b""
        except ConnectionError:
            pass
        assert time.monotonic() - begun < 15
        metrics = g.ask("GET", "/metrics")[1].decode()
        failed = [int(x.split()[1]) for x in metrics.splitlines() if x.startswith("axisgate_http_tls_handshakes_failed_total")]
        assert failed and failed[0] >= 1, failed
        for s in silent:
            s.close()
        assert g.stop() == 0


def test_a_stop_ends_open_tls_connections(folder):
    with SecureGateway(folder, *OWN) as g:
        c = g.connect()
        assert ask(c, "GET", "/healthz")[0] == 200
        with g.raw() as silent:
            silent.sendall(b"\x16")
            begun = time.monotonic()
            assert g.stop() == 0
            assert time.monotonic() - begun < 3


def test_the_self_made_certificate_stays(folder):
    with SecureGateway(folder, *OWN) as g:
        first = ssl.get_server_certificate(("127.0.0.1", g.port))
        assert stat.S_IMODE((folder / "data" / "http-key.pem").stat().st_mode) == 0o600
        assert g.stop() == 0
    with SecureGateway(folder, *OWN) as g:
        assert ssl.get_server_certificate(("127.0.0.1", g.port)) == first
        with g.trust.wrap_socket(g.raw(), server_hostname="127.0.0.1") as s:
            names = s.getpeercert()["subjectAltName"]
        for name in (("DNS", "localhost"), ("IP Address", "127.0.0.1"), ("DNS", socket.gethostname())):
            assert name in names, names
        assert g.stop() == 0
    # One with less than 30 days left, or half of a pair, is replaced.
    cert, key = certificate(folder, "short", "-days", "20")
    for c, k in ((cert, key), (cert, None)):
        (folder / "data" / "http-cert.pem").write_bytes(c.read_bytes())
        if k:
            (folder / "data" / "http-key.pem").write_bytes(k.read_bytes())
        with SecureGateway(folder, *OWN) as g:
            assert ssl.get_server_certificate(("127.0.0.1", g.port)).strip() != cert.read_text().strip()
            assert g.stop() == 0


def test_a_certificate_of_the_house(folder):
    cert, key = certificate(folder, "house")
    assert run("check", *files(cert, key))[0] == 0
    with SecureGateway(folder, *files(cert, key)) as g:
        g.trust = ssl.create_default_context(cafile=str(cert))
        s, _, head = g.ask("GET", "/healthz")
        assert s == 200 and head["Strict-Transport-Security"].startswith("max-age="), head
        assert not (folder / "data" / "http-key.pem").exists()
        assert g.stop() == 0


def test_faults_are_told_before_anything_is_opened(folder):
    cert, key = certificate(folder, "one")
    _, other = certificate(folder, "two")
    expired, expired_key = expired_pair(folder)
    nonsense = folder / "nonsense.pem"
    nonsense.write_text("hello")
    for pair, words in (((cert, other), "does not belong"), ((folder / "none.pem", key), "none.pem"), ((nonsense, key), "not a certificate"),
                        ((cert, nonsense), "not a private key"), ((expired, expired_key), "expired on 2021-01-02")):
        for arguments in (("check", *files(*pair)), ("serve", "--data", str(folder / "d"), *files(*pair))):
            code, _, errors = run(*arguments)
            assert code == 2 and words in errors and "http.tls_" in errors, (arguments, code, errors)
    assert not (folder / "d").exists(), "nothing was opened"
    assert run("serve", "--data", str(folder / "d"), "--set", f"http.tls_cert={cert}")[0] == 2


def expired_pair(folder):
    """`openssl ca` takes dates of the past; `openssl req` of Debian 12 does not."""
    _, key = certificate(folder, "old")
    (folder / "index").write_text("")
    (folder / "ca.cnf").write_text(f"[ca]\ndefault_ca=d\n[d]\ndatabase={folder}/index\nnew_certs_dir={folder}\nserial={folder}/serial\n"
                                   "default_md=sha256\npolicy=p\n[p]\ncommonName=supplied\n")
    subprocess.run(["openssl", "req", "-new", "-key", str(key), "-subj", "/CN=localhost", "-out", str(folder / "old.csr")], check=True, capture_output=True, timeout=30)
    subprocess.run(["openssl", "ca", "-batch", "-selfsign", "-config", str(folder / "ca.cnf"), "-keyfile", str(key), "-in", str(folder / "old.csr"), "-out",
                    str(folder / "old.pem"), "-create_serial", "-notext", "-startdate", "20210101000000Z", "-enddate", "20210102000000Z"],
                   check=True, capture_output=True, timeout=30)
    return folder / "old.pem", key

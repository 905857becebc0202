#!/usr/bin/env python3
"""Pictures over HTTP: clients that send too much, something else or nothing, or go away.

usage: http_limits_test.py CANDELA [TEST...]"""
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

from http_server import FOREVER, HANG, MODEL, SCENE, HttpCase, Server, form, head, main, receive, status_of


class HttpLimits(HttpCase):
    """What is refused, stopped or forgotten."""

    def test_bodies(self):
        self.assertEqual(status_of(self.server.send(b"POST /render HTTP/1.1\r\n\r\n")), 411)
        chunked = b"POST /render HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"
        self.assertEqual(status_of(self.server.send(chunked)), 411)
        for size in ("-1", "x", "+5", "1e3", "٣"):
            self.assertEqual(status_of(self.server.send(head(size))), 400)
        for size in (1 << 30, 10**30):  # Refused by its head.
            answer = self.server.send(head(size))
            self.assertEqual(status_of(answer), 413)
            self.assertIn(b"--max-body allows 67108864", answer)
        with self.server.connect() as connection:  # It asks first, and is told to go on, or not to.
            connection.sendall(head(len(SCENE)).replace(b"Host", b"Expect: 100-continue\r\nHost"))
            self.assertEqual(connection.recv(1 << 16), b"HTTP/1.1 100 Continue\r\n\r\n")
            connection.sendall(SCENE)
            self.assertEqual(status_of(receive(connection)), 200)
        self.assertEqual(status_of(self.server.send(head(1 << 30).replace(b"Host", b"Expect: 100-continue\r\nHost"))),
                         413)

    def test_a_gigabyte_is_refused_and_never_in_memory(self):
        def resident():
            pages = Path(f"/proc/{self.server.process.pid}/statm").read_text().split()[1]
            return int(pages) * os.sysconf("SC_PAGE_SIZE")
        self.server.picture("spp=1")
        before, block = resident(), bytes(1 << 20)
        with self.server.connect() as connection:
            connection.sendall(head(1 << 30))
            try:
                for _ in range(1 << 10):
                    connection.sendall(block)
            except OSError:
                pass  # It has read enough.
            self.assertEqual(status_of(receive(connection)), 413)
        self.assertLess(resident() - before, 32 << 20)

    def test_forms_that_are_malformed(self):
        good, headers = form([("spp", None, b"1"), ("scene", "a.gltf", SCENE)])
        self.assertEqual(self.server.ask("POST", "/render", good, headers)[0], 200)
        field = b'--b\r\nContent-Disposition: form-data; name="spp"\r\n\r\n'
        self.assertEqual(self.server.ask("POST", "/render", b"before\r\n" + good + b"after", headers)[0], 200)
        wrong = [
            (good[:-4], "within|not followed"),
            (good[:200], "it ends within the part 'scene'"),
            (b"", "it ends within"),
            (good.replace(b"--b", b"--c"), "it ends within"),
            (b"--b\r\n\r\n1\r\n--b--\r\n", "it ends within|has no name"),
            (b"--bx\r\n", "not followed by"),
            (b"--b\r\nX: y\r\n\r\n1\r\n--b--", "has no name"),
            (b'--b\r\nContent-Disposition: file; name="a"\r\n\r\n1\r\n--b--', "has no name"),
            (field + b"1\r\n" + field + b"1\r\n--b--", "'spp' is there twice"),
            (good[:-5] + good, "not followed by|twice"),
            (form([("scene", "a", SCENE), ("scene", "b", SCENE)])[0], "'scene' is there twice"),
            (b"--b\r\n" + 9000 * b"a", "the head of a part has more than 8192"),
            (field + 70000 * b"1", "has more than 65536"),
            (field + b"\xff\r\n--b--", "is not text in UTF-8"),
            (form([(f"a{i}", None, b"1") for i in range(99)])[0], "more than 64 parts"),
            (form([("spp", None, b"1")])[0], "either a scene, or"),
        ]
        for body, message in wrong:
            self.assert_refused(400, message, self.server.ask("POST", "/render", body, headers))
        for kind in ("multipart/form-data", 'multipart/form-data; boundary=""', "multipart/form-data; boundary="
                     + 80 * "b", "multipart/form-data; boundary=\xe4"):
            answer = self.server.ask("POST", "/render", good, {"Content-Type": kind})
            self.assert_refused(400, "names no boundary|it ends within", answer)
        boundary = "\r\n--b".encode()  # Parts of boundaries are content.
        scene = SCENE + b" " + boundary[:3] + b" \n\r\n--\n"
        for size in (1 << 16, (1 << 16) - 1, (1 << 16) + 2):
            padded = scene + b" " * (size - len(scene))
            self.assertEqual(self.server.ask("POST", "/render?spp=1", *form([("scene", "a", padded)]))[0], 422)

    def test_clients_that_go_away(self):
        before = self.server.metrics()["candela_cancelled_total"]
        query = f"/render?spp={FOREVER}&size=16x12"
        for data in (head(len(SCENE))[:40], head(len(SCENE)) + SCENE[:50],
                     head(99999, "multipart/form-data; boundary=b") + b"--b\r\n"):
            with self.server.connect() as connection:
                connection.sendall(data)
        connections = []
        for _ in range(4):  # One is rendered, the others wait.
            connections.append(self.server.connect())
            connections[-1].sendall(head(len(SCENE), path=query) + SCENE)
        self.server.wait_until("candela_requests_pending", 4)
        for connection in reversed(connections):
            connection.close()
        self.server.wait_until("candela_requests_pending", 0)
        self.server.wait_until("candela_cancelled_total", before + 6)

    def test_clients_that_are_killed(self):
        code = f"import socket, sys\ns = socket.create_connection(('127.0.0.1', {self.server.port}))\n" \
               f"s.sendall({head(len(SCENE), path=f'/render?spp={FOREVER}') + SCENE!r})\nprint(flush=True)\ns.recv(1)"
        clients = [subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) for _ in range(4)]
        for client in clients:
            client.stdout.readline()
        self.server.wait_until("candela_requests_pending", 4)
        for client in clients:
            client.kill()
            client.communicate()
        self.server.wait_until("candela_requests_pending", 0)

    def test_a_client_that_reads_nothing(self):
        with self.server.connect() as connection:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            connection.sendall(head(len(SCENE), path="/render?spp=1&size=640x480&format=exr&layers=all") + SCENE)
            self.server.wait_until("candela_requests_pending", 1)
            self.server.picture("spp=1")  # Others do not wait for it.

    def test_memory(self):
        before = self.server.metrics()
        self.assert_refused(413, "need at least .* bytes, and the server's --memory-limit allows 1000000000",
                            self.server.ask("POST", "/render?size=65536x65536", SCENE, MODEL))
        self.assertEqual(self.server.metrics()["candela_scenes_loaded_total"], before["candela_scenes_loaded_total"])
        count = 4000000  # Vertices of 12 bytes: the file fits, and what is made of it does not.
        ply = (f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n"
               f"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n").encode()
        ply += struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + bytes(12 * (count - 3)) + struct.pack("<B3i", 3, 0, 1, 2)
        with Server("--memory-limit", "64MiB") as server:
            self.assert_refused(413, "^request: there is not enough memory for the scene", server.ask("POST", "/render",
                                                                                                      ply, MODEL))
            self.assert_fine(server)

    def test_a_program_that_has_grown_begins_anew(self):
        with Server("--memory-limit", "64MiB",
                    code="import candela.serve._renderer as r\nr.PROGRAM_BYTES = 0") as server:
            first = server.picture("spp=2")
            self.assertEqual(server.picture("spp=2"), first)
            metrics = server.metrics()
            self.assertEqual((metrics["candela_scenes_reused_total"], metrics["candela_scenes_loaded_total"]), (0, 2))
            self.assertGreaterEqual(metrics["candela_program_starts_total"], 2)

    def test_time(self):
        with Server("--time-limit", "3") as server:
            self.assert_refused(504, "took longer than 3 s", server.ask("POST", f"/render?spp={FOREVER}", SCENE, MODEL))
            self.render_once(server)
            status, headers, _ = server.ask("POST", f"/render?spp={FOREVER}&time_limit=0.2", SCENE, MODEL)
            self.assertEqual((status, headers["Candela-Complete"]), (200, "false"))
            os.kill(server.program(), signal.SIGSTOP)  # It hangs, and does not even hear that it is cancelled.
            self.assert_refused(504, "took longer than 3 s", server.ask("POST", "/render?spp=1", SCENE, MODEL))
            self.render_once(server)
            self.assert_fine(server)
            self.assertEqual(server.metrics()["candela_program_starts_total"], 2)

    @staticmethod
    def render_once(server):
        """Renders, as often as it takes: on a busy machine, the first pictures of a program may need more time."""
        for _ in range(HANG // 3):
            if server.ask("POST", "/render?spp=1", SCENE, MODEL)[0] == 200:
                return
        raise AssertionError("the server renders no more")

    def test_clients_that_are_slow(self):
        with Server(code="import candela.serve._body as b\nb.PATIENCE = 0.3") as server:
            with server.connect() as connection:
                connection.sendall(head(len(SCENE)) + SCENE[:9])
                self.assertEqual(status_of(receive(connection)), 408)
            with server.connect() as connection:
                connection.sendall(b"POST /render HTTP/1.1\r\nHos")
                self.assertEqual(receive(connection), b"")
            self.assert_fine(server)

    def test_a_program_that_crashes(self):
        answers = []
        asking = threading.Thread(target=lambda: answers.append(
            self.server.ask("POST", f"/render?spp={FOREVER}", SCENE, MODEL)))
        asking.start()
        self.server.wait_until("candela_requests_pending", 1)
        os.kill(self.server.program(), signal.SIGKILL)
        asking.join(HANG)
        self.assert_refused(500, "the program ended: signal 9", answers[0])

    def test_a_hundred_at_once(self):
        for queue, refused in ((100, False), (3, True)):
            with Server("--queue", str(queue)) as server:
                expected = server.picture("spp=4&seed=7")
                answers = []
                together = threading.Barrier(100)

                def ask(server=server, answers=answers, together=together):
                    together.wait(HANG)
                    answers.append(server.ask("POST", "/render?size=16x12&spp=4&seed=7", SCENE, MODEL))
                threads = [threading.Thread(target=ask) for _ in range(100)]
                began = time.monotonic()
                for thread in threads:
                    thread.start()
                for thread in threads:
                    thread.join(HANG)
                took = time.monotonic() - began
                found = [status for status, _, _ in answers]
                print(f"100 requests at once, of which {queue} may wait: {found.count(200)} pictures, "
                      f"{found.count(429)} refused, {took:.2f} s")
                self.assertEqual(found.count(200) + found.count(429), 100)
                for answer in answers:
                    if answer[0] == 200:
                        self.assertEqual(answer[2], expected)
                    else:
                        self.assert_refused(429, f"{queue} requests wait already", answer)
                        self.assertEqual(answer[1]["Retry-After"], "1")
                self.assertEqual(429 in found, refused)
                self.assertIn(200, found)
                self.assert_fine(server)

    def test_it_ends_and_leaves_nothing(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with Server() as server:
                program = server.program()
                with server.connect() as connection:
                    connection.sendall(head(len(SCENE), path=f"/render?spp={FOREVER}") + SCENE)
                    server.wait_until("candela_requests_pending", 1)
                    server.process.send_signal(number)
                    self.assertEqual((server.process.wait(HANG), server.process.stderr.read()), (0, ""))
                self.assertEqual(os.listdir(server.folder.name), [])
                self.assertFalse(os.path.exists(f"/proc/{program}"))


if __name__ == "__main__":
    main()

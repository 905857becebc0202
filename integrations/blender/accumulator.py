# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a scene that gets better as long as nobody changes it, in a thread of its own."""
import threading
import time

import numpy

from . import candela

# Seconds until the first picture of a new view, which has larger pixels if it takes that; and between two pictures later.
_FIRST = 0.04
_INTERVAL = 0.5
# Seconds that a picture goes on after it was cancelled.
_LATENCY = 0.02
# Pixels that any device renders in that time, until it is known how many this one does.
_CAUTIOUS = 4096
_COARSEST = 16


class Look:
    """What is to be seen: (width, height) of the whole picture, the part of it [pixels] that is wanted, the keys of a camera,
    and options of the request. is_outside: parallel rays begin before all of the scene."""

    def __init__(self, size, crop, camera, is_outside=False, samples=1024, **options):
        self.size = tuple(size)
        self.crop = tuple(crop)
        self.camera = camera
        self.is_outside = is_outside
        self.samples = samples
        self.options = options

    def __eq__(self, other):
        return isinstance(other, Look) and vars(self) == vars(other)


class Picture:
    """pixels: (H, W, 4), premultiplied, rows upwards, of the part `crop` of a view of `size`, perhaps fewer than that has; of a
    look at the scene of a draft. `spp` samples a pixel."""

    def __init__(self, pixels, look, draft, spp):
        self.pixels = pixels
        self.size = look.size
        self.crop = look.crop
        self.look = look
        self.draft = draft
        self.spp = spp

    @property
    def is_whole(self):
        """Whether its pixels are those of the view."""
        x0, y0, x1, y1 = self.crop
        return self.pixels.shape[:2] == (y1 - y0, x1 - x0)


class Accumulator:
    """Follows a scene and a look at it. Its functions return at once; whoever owns it calls close()."""

    def __init__(self, tell):
        """tell: is called, by the thread, when there is another picture or message."""
        self._tell = tell
        self._lock = threading.Condition()
        self._session = None
        self._draft = None  # That is to be followed.
        self._look = None
        self._is_new = False  # There is something that the thread has not begun.
        self._is_closed = False
        self._request = None  # The number of the request that may be cancelled.
        self._latest = None
        self._message = ""
        self._scene = None  # The thread's own.
        self._followed = None
        self._rate = 0.0  # Samples a second.
        self.restarts = 0
        self._thread = threading.Thread(target=self._run, name="candela viewport", daemon=True)
        self._thread.start()

    def follow(self, session, draft):
        """Another state of the scene."""
        with self._lock:
            self._session, self._draft = session, draft
            self._restart()

    def look(self, look):
        """Another look at it."""
        with self._lock:
            if self._look != look:
                self._look = look
                self._restart()

    @property
    def latest(self):
        """The latest Picture; None before the first."""
        with self._lock:
            return self._latest

    @property
    def message(self):
        """What is being done, or what has failed."""
        with self._lock:
            return self._message

    @property
    def needs_session(self):
        """Whether the program has ended, and follow() is wanted with another one."""
        with self._lock:
            return self._session is not None and not self._session.is_open

    def close(self):
        """Ends the thread, and frees the scene."""
        with self._lock:
            self._is_closed = True
            self._restart()

    def wait_for(self, spp, timeout):
        """The first whole picture of what is to be seen now with so many samples; None if it does not come in these seconds."""
        def is_there():
            return self._latest is not None and self._latest.look is self._look and self._latest.draft is self._draft and \
                self._latest.spp >= spp and self._latest.is_whole
        with self._lock:
            return self._latest if self._lock.wait_for(is_there, timeout) else None

    def _restart(self):
        self._is_new = True
        self._lock.notify_all()
        if self._request is not None:
            self._cancel(self._request)
            self._request = None

    def _cancel(self, number):
        try:
            self._session._connection.cancel(number)
        except candela.Error:
            pass  # The thread learns why.

    def _run(self):
        while True:
            with self._lock:
                while not self._is_new:
                    self._lock.wait()
                self._is_new = False
                if self._is_closed:
                    break
                session, draft, look = self._session, self._draft, self._look
            if draft is None or look is None:
                continue
            try:
                self._follow(session, draft)
                self._accumulate(look)
            except Exception as error:  # A thread that ends would leave the viewport as it is.
                if getattr(error, "kind", "") != "cancelled":
                    self.say(str(error) or repr(error))
        self._close_scene()

    def _close_scene(self):
        try:
            if self._scene is not None:
                self._scene.close()
        except candela.Error:
            pass

    def _follow(self, session, draft):
        if self._scene is None or self._scene._connection is not session._connection:
            self._scene, self._followed = candela.Scene(draft.size, session), None
        if self._followed is not draft:
            self._followed = None  # If this fails, it is tried again.
            self._scene._follow(draft)
            self._followed = draft

    def _accumulate(self, look):
        """Renders until all samples are there, or something is new."""
        with self._lock:
            self.restarts += 1
        camera = self._outside(look) if look.is_outside else look.camera
        coarse, goal, is_first = self._coarseness(look), 1, True
        while True:
            began = time.monotonic()
            # The first picture, which takes no time, is not cancelled: while a view turns, there would be none.
            outcome = self._render(look, camera, coarse, goal, is_first)
            if outcome is None:
                return
            is_first = False
            seconds = time.monotonic() - began
            if coarse > 1:
                coarse = max(1, coarse // 4)
            elif goal >= look.samples:
                return
            else:
                goal = min(look.samples, goal * 2 if seconds < _INTERVAL else goal + max(1, int(goal * _INTERVAL / seconds)))

    def _coarseness(self, look):
        """How many pixels of the view are one of the first picture, along each side."""
        x0, y0, x1, y1 = look.crop
        pixels = max(_CAUTIOUS, self._rate * _FIRST)
        coarse = 1
        while coarse < _COARSEST and (x1 - x0) * (y1 - y0) / coarse ** 2 > pixels:
            coarse *= 2
        return coarse

    def _render(self, look, camera, coarse, goal, is_first):
        """Renders a picture and shows it; None if something else is wanted meanwhile."""
        size = [max(1, side // coarse) for side in look.size]
        crop = _coarse_crop(look, size)
        params = {"scene": self._scene._id, "camera": camera, "size": size, "crop": crop, "spp": goal,
                  "layers": ["rgb", "alpha"], "latency": _LATENCY, **look.options}

        def sent(number):
            with self._lock:
                if self._is_new and not is_first:
                    self._cancel(number)
                elif not is_first:
                    self._request = number
        began = time.monotonic()
        connection = self._scene._connection
        try:
            outcome = connection.call("render", params, sent=sent)
        finally:
            with self._lock:
                self._request = None
        if not outcome["complete"]:
            return None
        self._note_rate((crop[2] - crop[0]) * (crop[3] - crop[1]), goal, time.monotonic() - began)
        image = candela.Image(connection, connection.call("image", {"scene": self._scene._id}))
        pixels = numpy.concatenate([image.rgb, image.alpha[..., None]], -1)[::-1]
        with self._lock:
            self._latest = Picture(numpy.ascontiguousarray(pixels), look, self._followed, image.spp)
            self._message = f"{image.spp} of {look.samples} samples"
            is_wanted = not self._is_new
            self._lock.notify_all()
        self._tell()
        return outcome if is_wanted else None

    def _note_rate(self, pixels, goal, seconds):
        # Later passes go on from the samples before.
        if goal == 1 and seconds > 0:
            self._rate = pixels / seconds

    def _outside(self, look):
        """The camera moved backwards, in front of all that the scene has."""
        bounds = self._scene.bounds
        if bounds is None:
            return look.camera
        position, target = (numpy.array(look.camera[key]) for key in ("position", "look_at"))
        forward = (target - position) / numpy.linalg.norm(target - position)
        nearest = sum(min(bounds[0][i] * forward[i], bounds[1][i] * forward[i]) for i in range(3))
        back = position @ forward - nearest + 1e-3 * float(numpy.linalg.norm(bounds[1] - bounds[0])) + 1e-6
        return {**look.camera, "position": (position - back * forward).tolist(), "look_at": (target - back * forward).tolist()}

    def say(self, text):
        """Another message."""
        with self._lock:
            self._message = text
            self._lock.notify_all()
        self._tell()


def _coarse_crop(look, size):
    """Where the part that is wanted is in a smaller picture of the same view."""
    x0, y0, x1, y1 = (edge * side / whole for edge, side, whole in zip(look.crop, size * 2, look.size * 2))
    left, top = min(int(x0), size[0] - 1), min(int(y0), size[1] - 1)
    return [left, top, max(left + 1, min(round(x1), size[0])), max(top + 1, min(round(y1), size[1]))]

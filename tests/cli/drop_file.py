#!/usr/bin/python3
"""Drops a file onto a window of an X server, as a file manager would (XDND, version 5), and waits until the window has
taken it.

usage: drop_file.py TITLE FILE      TITLE: of the window, or a part of it. Needs DISPLAY and python3-xlib.
"""
import sys
from pathlib import Path

from Xlib import X, display
from Xlib.protocol import event


def find(window, title):
    """The first window below this one that takes drops and whose title contains that one."""
    name = window.get_wm_name()
    aware = window.display.get_atom("XdndAware")
    if name and title in name and window.get_full_property(aware, X.AnyPropertyType):
        return window
    for child in window.query_tree().children:
        found = find(child, title)
        if found:
            return found
    return None


def main():
    title, file = sys.argv[1:]
    server = display.Display()
    atom = server.get_atom
    root = server.screen().root
    target = find(root, title)
    if target is None:
        sys.exit(f"There is no window of that title that takes drops: {title}")
    source = root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
    uris = atom("text/uri-list")

    def send(kind, *words):
        data = (32, [source.id, *words, *[0] * (4 - len(words))])
        target.send_event(event.ClientMessage(window=target, client_type=atom(kind), data=data))

    def wait(kind):
        while True:
            server.flush()
            what = server.next_event()
            if what.type == X.SelectionRequest:
                text = (Path(file).resolve().as_uri() + "\r\n").encode()
                what.requestor.change_property(what.property, uris, 8, text)
                what.requestor.send_event(event.SelectionNotify(time=what.time, requestor=what.requestor,
                                                                selection=what.selection, target=what.target,
                                                                property=what.property))
            elif what.type == X.ClientMessage and what.client_type == atom(kind):
                return what.data[1][1]

    source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
    place = target.get_geometry()
    send("XdndEnter", 5 << 24, uris, X.NONE)
    send("XdndPosition", 0, (place.x + 10) << 16 | (place.y + 10), X.CurrentTime, atom("XdndActionCopy"))
    if not wait("XdndStatus") & 1:
        sys.exit("The window refuses the file.")
    send("XdndDrop", 0, X.CurrentTime)
    wait("XdndFinished")


if __name__ == "__main__":
    main()

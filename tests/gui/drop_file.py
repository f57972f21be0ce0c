#!/usr/bin/env python3
"""Drops files on a window as a file manager does, by the X drag-and-drop protocol: drop_file.py WINDOW PATHS X Y
PATHS: one a line; what begins with a scheme ("file:", "http:") is dropped as it is."""
import re
import sys
import time

from Xlib import X, display
from Xlib.protocol import event

window, paths, x, y = int(sys.argv[1]), sys.argv[2].split("\n"), int(sys.argv[3]), int(sys.argv[4])
uris = "".join((path if re.match("[a-zA-Z]+:", path) else f"file://{path}") + "\r\n" for path in paths)
screen = display.Display()
atom = screen.intern_atom
target = screen.create_resource_object("window", window)
source = screen.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)


def tell(kind, *data):
    message = event.ClientMessage(window=target, client_type=atom(kind), data=(32, [source.id, *data]))
    target.send_event(message, event_mask=0)
    screen.flush()


source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
tell("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
tell("XdndPosition", 0, x << 16 | y, X.CurrentTime, atom("XdndActionCopy"))
end = time.monotonic() + 10
while time.monotonic() < end:
    if not screen.pending_events():
        time.sleep(0.02)
        continue
    e = screen.next_event()
    if e.type == X.ClientMessage and e.client_type == atom("XdndStatus"):
        if not e.data[1][1] & 1:
            sys.exit("the window does not take it")
        tell("XdndDrop", 0, X.CurrentTime, 0, 0)
    elif e.type == X.ClientMessage and e.client_type == atom("XdndFinished"):
        sys.exit(0)
    elif e.type == X.SelectionRequest:
        e.requestor.change_property(e.property, e.target, 8, uris.encode())
        e.requestor.send_event(event.SelectionNotify(time=e.time, requestor=e.requestor, selection=e.selection,
                                                     target=e.target, property=e.property))
        screen.flush()
sys.exit("the window did not finish the drop")

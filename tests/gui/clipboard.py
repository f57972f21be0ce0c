#!/usr/bin/env python3
"""Owns the clipboard until it is killed: clipboard.py [TEXT]. Says "ready" once it does. Without a text it never answers."""
import sys

from Xlib import X, Xatom, display
from Xlib.protocol import event

screen = display.Display()
atom = screen.intern_atom
window = screen.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
window.set_selection_owner(atom("CLIPBOARD"), X.CurrentTime)
screen.sync()
print("ready", flush=True)
while True:
    e = screen.next_event()
    if e.type != X.SelectionRequest or len(sys.argv) == 1:
        continue
    place = e.property or e.target
    if e.target == atom("TARGETS"):
        e.requestor.change_property(place, Xatom.ATOM, 32, [atom("UTF8_STRING"), atom("TARGETS")])
    elif e.target == atom("UTF8_STRING"):
        e.requestor.change_property(place, e.target, 8, sys.argv[1].encode())
    else:
        place = 0
    e.requestor.send_event(event.SelectionNotify(time=e.time, requestor=e.requestor, selection=e.selection,
                                                 target=e.target, property=place))
    screen.flush()

# SPDX-License-Identifier: BSD-3-Clause
"""Locks for what several threads may do at once."""

import os
import threading


def lock_in(locks):
    """The lock that the dict `locks` keeps. A forked child gets another one: the thread that held the first may not be there."""
    return locks.setdefault(os.getpid(), threading.RLock())

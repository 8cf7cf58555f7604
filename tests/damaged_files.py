"""Files damaged at random, for tests that any file is read or refused."""

from __future__ import annotations

from hypothesis import strategies as st

WORDS = [b"0", b"-1", b"1e999", b"nan", b"NaN", b"400000000", b"99999999999999999999", b"\n", b" ", b"\0", b"\xff" * 4]
WORDS += [b"list", b"null", b'"', b"{", b"[" * 200, b'{"a":' * 200, b'"shapes": [],', b"\\ud800", b"\xed\xa0\x80"]


def damaged(good: bytes, data: st.DataObject) -> bytes:
    """Return the bytes with parts changed, cut out, repeated, added or cut off at the end, several times."""
    bad = bytearray(good)
    for _ in range(data.draw(st.integers(1, 4))):
        at, end = sorted(data.draw(st.tuples(*[st.integers(0, len(bad))] * 2)))
        how = data.draw(st.sampled_from(["change", "cut", "repeat", "put in", "replace word", "end"]))
        if how == "change" and at < len(bad):
            bad[at] ^= 1 << data.draw(st.integers(0, 7))
        elif how == "cut":
            del bad[at : min(end, at + 9)]
        elif how == "repeat":
            bad[at:at] = bad[at : min(end, at + 40)]
        elif how == "put in":
            bad[at:at] = data.draw(st.sampled_from(WORDS))
        elif how == "replace word":
            bad[at : at + 1 + bad[at : at + 20].find(b" ")] = data.draw(st.sampled_from(WORDS))
        elif how == "end":
            del bad[at:]
    return bytes(bad)

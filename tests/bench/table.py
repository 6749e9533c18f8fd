"""Rows of measurements and how they are shown.

A row: what was measured, ours and a peer's figure in one unit (smaller is better), ratio = peer / ours, the errors of both
where the case has a reference, and the floor: what the machine itself could do, or for a figure without a peer what we
promise. `least` is the ratio that we promise. A promise that is not kept is marked."""


def row(bench, case, ours, unit, floor=None, peer_name=None, peer=None, error_ours=None, error_peer=None, least=None):
    return {"bench": bench, "case": case, "ours": ours, "peer_name": peer_name, "peer": peer, "unit": unit,
            "ratio": peer / ours if peer is not None and ours else None, "error_ours": error_ours, "error_peer": error_peer,
            "floor": floor, "least": least}


def remark(r):
    """What the reader should see at once: a promise that is not kept."""
    if r["least"] is not None:
        return "" if r["ratio"] >= r["least"] else f"  BELOW {r['least']:g}x"
    if r["peer"] is None and r["floor"] is not None and r["ours"] > r["floor"]:
        return "  over its floor"
    return ""


LINE = "%-10s %-58s %10s %-4s %-21s %10s %7s %7s %9s %9s %8s%s"


def show_head():
    print((LINE % ("bench", "case", "ours", "", "peer", "", "ratio", "least", "error", "peer's", "floor", "")).rstrip(), flush=True)


def show(r):
    def figure(value):
        return "%.3g" % value if value is not None else "-"

    print((LINE % (r["bench"], r["case"], figure(r["ours"]), r["unit"], r["peer_name"] or "-", figure(r["peer"]), figure(r["ratio"]),
                   figure(r["least"]), figure(r["error_ours"]), figure(r["error_peer"]), figure(r["floor"]), remark(r))).rstrip(), flush=True)

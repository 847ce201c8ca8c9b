"""Decisions of actors as they are told over the wire."""

import base64
from typing import Any, Final

import numpy as np

from esplanade.actors.traces import COST_PARTS, PricedPath, RiskSlices, Trace
from esplanade.server.live.traces import Traced

_DIGITS: Final = 4
"""Of costs in seconds; so that their parts add up to less than a millisecond."""


def told_cost(path: PricedPath) -> dict[str, float | None]:
    """The parts of the cost of a path by their names, in seconds; None for one without an end."""
    return {
        name: round(value, _DIGITS) if np.isfinite(value) else None
        for name, value in zip(COST_PARTS, path.cost.tolist(), strict=True)
    }


def told_path(path: PricedPath | None, slice_s: float) -> dict[str, Any] | None:
    """The places of a path with their times, and its cost."""
    if path is None:
        return None
    times = np.arange(len(path.places)) * slice_s
    return {
        "path": np.column_stack([path.places, times]).round(3).tolist(),
        "cost": told_cost(path),
        "mean_risk": round(path.mean_risk, 5),
        "legal": path.legal,
    }


def told_trace(actor: str, traced: Traced, slice_s: float) -> dict[str, Any]:
    """A decision with all that it was made of, but for who held the actor."""
    trace, tree = traced.trace, traced.trace.tree
    return {
        "actor": actor,
        "tick": traced.tick,
        "exact": trace.exact,
        "seconds": round(traced.seconds, 6),
        "status": tree.status.name.lower(),
        "expansions": tree.expansions,
        "budget": tree.budget,
        "nodes": _told_nodes(trace),
        "left_out": tree.left_out,
        **(told_path(trace.decided.taken, slice_s) or {}),
        "previous": told_path(trace.decided.previous, slice_s),
        "searched": told_path(trace.searched, slice_s),
        "perturbed": told_path(trace.perturbed, slice_s),
        "why": _told_why(trace),
        "risk": _told_risk(trace.risk),
    }


def _told_nodes(trace: Trace) -> list[list[float]]:
    nodes = trace.tree.nodes
    columns = [
        *(nodes[:, k].round(3).tolist() for k in range(4)),
        nodes[:, 4].astype(np.int64).tolist(),
        nodes[:, 5].round(_DIGITS).tolist(),
        nodes[:, 6].astype(np.int64).tolist(),
    ]
    return [list(node) for node in zip(*columns, strict=True)]


def _told_why(trace: Trace) -> dict[str, Any]:
    """The choice of a path, as a code with the costs that were compared, and a text beside."""
    taken_s = trace.decided.taken.total_s
    before_s = None if trace.perturbed is None else trace.perturbed.total_s
    margin_s = trace.hysteresis_s
    match trace.winner:
        case "first":
            text = "it followed no path to this goal before, so the path of the search was taken"
        case "forced":
            text = (
                "the path followed before is not possible any more, so that of the search was taken"
            )
        case "search":
            text = (
                f"the search found a path that costs {taken_s:.2f} s; the one before would have "
                f"cost {before_s:.2f} s, which is more by {margin_s:g} s at least"
            )
        case "perturbation":
            text = (
                f"the path followed before was bent, for less risk, and costs {taken_s:.2f} s; the "
                f"search found none that costs less by {margin_s:g} s"
            )
        case "kept":
            text = (
                f"the path followed before costs {taken_s:.2f} s; no bend is better, and the "
                f"search found none that costs less by {margin_s:g} s"
            )
        case "not_due":
            text = (
                "it was not due in this tick, since actors are planned in turns, and goes on "
                "along the path followed before"
            )
    arguments = {
        "taken_s": _rounded(taken_s),
        "before_s": _rounded(before_s),
        "searched_s": None if trace.searched is None else _rounded(trace.searched.total_s),
        "hysteresis_s": margin_s,
    }
    return {"code": trace.winner, "text": text, "arguments": arguments}


def _rounded(seconds: float | None) -> float | None:
    return None if seconds is None or not np.isfinite(seconds) else round(seconds, _DIGITS)


def _told_risk(risk: RiskSlices) -> list[dict[str, Any]]:
    _, height, width = risk.values.shape
    return [
        {
            "t_s": round(t_s, 3),
            "width": width,
            "height": height,
            "cell_m": risk.cell_m,
            "origin_m": list(risk.origin_m),
            "values": base64.b64encode(values.astype("<f4").tobytes()).decode(),
        }
        for t_s, values in zip(risk.times_s.tolist(), risk.values, strict=True)
    ]

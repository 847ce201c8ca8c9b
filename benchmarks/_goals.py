"""A table of figures beside the goals that they have to reach."""

from dataclasses import dataclass, field


@dataclass
class Goals:
    """Collects figures, and prints them at the end."""

    rows: list[tuple[str, float, float | None, str]] = field(default_factory=list)

    def add(self, what: str, value: float, goal: float | None = None, unit: str = "ms") -> None:
        """A figure; it must not lie above its goal, where it has one."""
        self.rows.append((what, value, goal, unit))

    def print(self) -> None:
        """Print all of them."""
        print()
        print(f"{'figure':58} {'measured':>12} {'goal':>10}")
        for what, value, goal, unit in self.rows:
            wanted = "" if goal is None else f"{goal:g} {unit}"
            verdict = "" if goal is None else "reached" if value <= goal else "MISSED"
            print(f"{what:58} {value:9.3f} {unit:2} {wanted:>10} {verdict}")

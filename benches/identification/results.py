"""Results as CSV, JSON and Markdown; docs/benchmark.md describes the columns."""

import csv
import io
import json
import math
import os

COLUMNS = ("data", "task", "kind", "prediction", "restart_s", "peer", "standardised_error",
           "heading_deg", "u_m_s", "v_m_s", "r_deg_s", "runs", "diverged", "parameters",
           "seconds", "memory_mb", "ratio_to_best", "cannot", "settings", "program")


def with_ratios(rows):
    """Adds the ratio of each standardised error to the least one of the same task."""
    for row in rows:
        alike = [other["standardised_error"] for other in rows if same_task(row, other)
                 and other.get("standardised_error") is not None]
        error = row.get("standardised_error")
        row["ratio_to_best"] = None if error is None else error / max(min(alike), 1e-12)
    return rows


def same_task(one, other):
    keys = ("data", "task", "prediction")
    return all(one[key] == other[key] for key in keys)


def write(folder, rows, about):
    """Writes all three files; each replaces its predecessor at once."""
    os.makedirs(folder, exist_ok=True)
    table = io.StringIO(newline="")
    writer = csv.DictWriter(table, COLUMNS, restval="", extrasaction="ignore")
    writer.writeheader()
    writer.writerows(rows)
    texts = {"results.json": json.dumps({"about": about, "rows": rows}, indent=1),
             "results.csv": table.getvalue(), "results.md": markdown(rows, about)}
    for name, text in texts.items():
        path = os.path.join(folder, name)
        with open(f"{path}.new", "w", newline="") as file:
            file.write(text)
        os.replace(f"{path}.new", path)


def markdown(rows, about):
    peers = list(dict.fromkeys(row["peer"] for row in rows))
    return "\n".join([*losses(rows), "", *error_table(rows, peers), "", *cost_table(rows, peers),
                      "", *refusals(rows), *machine(about), ""])


def error_table(rows, peers):
    """Standardised errors, a row per task and a column per peer; the least of each is bold."""
    lines = ["| data | task | prediction | " + " | ".join(peers) + " |",
             "| --- | --- | --- |" + " --: |" * len(peers)]
    for key in dict.fromkeys((r["data"], r["task"], r["prediction"]) for r in rows):
        if key[2] == "-":
            continue
        cells = [cell(find(rows, key, peer)) for peer in peers]
        lines.append("| " + " | ".join([*key, *cells]) + " |")
    return lines


def find(rows, key, peer):
    found = [r for r in rows if r["peer"] == peer and (r["data"], r["task"]) == key[:2]
             and r["prediction"] in (key[2], "-")]
    return found[0] if found else None


def cell(row):
    if row is None:
        return ""
    if row.get("standardised_error") is None:
        return "cannot"
    text = significant(row["standardised_error"])
    text = f"**{text}**" if row["ratio_to_best"] < 1.0000001 else text
    return text + (f" ({row['diverged']:.0%} diverged)" if row["diverged"] else "")


def significant(value):
    if value is None:
        return "-"
    if isinstance(value, int) or abs(value) >= 100:
        return f"{value:.0f}"
    digits = max(0, 2 - math.floor(math.log10(abs(value)))) if value else 0
    return f"{value:.{digits}f}"


def losses(rows, ours="sistership"):
    """Tasks in which a peer has less than two thirds of our error, the worst first."""
    worse = sorted((r for r in rows if r["peer"] == ours and (r.get("ratio_to_best") or 0) > 1.5),
                   key=lambda r: -r["ratio_to_best"])
    lines = ["| where the default call loses | error by that of the best | best | selected |",
             "| --- | --: | --- | --- |"]
    for row in worse:
        best = next(r for r in rows if same_task(r, row) and r.get("ratio_to_best")
                    and r["ratio_to_best"] < 1.0000001)
        lines.append(f"| {row['data']}, {row['task']}, {row['prediction']} | "
                     f"{row['ratio_to_best']:.1f} | {best['peer']} | {row['settings']} |")
    return lines


def cost_table(rows, peers):
    """What each peer needs and how often it is best, over all tasks that it can do."""
    lines = ["| peer | tasks | best | geometric mean of the ratio to the best | runs diverged "
             "| parameters | seconds | MB |", "| --- | " + "--: | " * 7]
    for peer in peers:
        done = [r for r in rows if r["peer"] == peer and r.get("standardised_error") is not None]
        if not done:
            lines.append(f"| {peer} | 0 | - | - | - | - | - | - |")
            continue
        ratio = math.exp(sum(math.log(r["ratio_to_best"]) for r in done) / len(done))
        share = sum(r["diverged"] * r["runs"] for r in done) / sum(r["runs"] for r in done)
        best = sum(r["ratio_to_best"] < 1.0000001 for r in done)
        cells = [spread(r["parameters"] for r in done), spread(r["seconds"] for r in done),
                 spread(r["memory_mb"] for r in done)]
        lines.append(f"| {peer} | {len(done)} | {best} | {ratio:.2f} | {share:.1%} | "
                     + " | ".join(cells) + " |")
    return lines


def spread(values):
    """Least and largest value."""
    found = [value for value in values if value is not None]
    if not found:
        return "-"
    low, high = significant(min(found)), significant(max(found))
    return low if low == high else f"{low} to {high}"


def refusals(rows):
    """What a peer cannot do, once per reason."""
    reasons = {}
    for row in rows:
        if row.get("cannot"):
            reasons.setdefault((row["peer"], row["cannot"]), []).append(
                f"{row['data']}/{row['task']}")
    return [f"- {peer}: {reason} ({', '.join(tasks)})" for (peer, reason), tasks in reasons.items()]


def machine(about):
    versions = ", ".join(f"{name} {version}" for name, version in about["versions"].items())
    return ["", f"{about['date']}, {about['machine']}, {about['cores']} cores, one process at a "
            f"time; {about['program']}; Python {about['python']}, {versions}; seeds: 1 for every "
            f"peer, those in the names of made ships."]

"""Results as CSV, JSON and Markdown; docs/benchmark.md describes the columns.

`python3 results.py FOLDER PAGE` puts the tables of a folder of results into a page, between its
lines `<!-- results -->` and `<!-- end of results -->`, and the rows as CSV beside it.
"""

import csv
import io
import json
import math
import os
import shutil
import sys

COLUMNS = ("data", "task", "kind", "prediction", "restart_s", "peer", "standardised_error",
           "heading_deg", "u_m_s", "v_m_s", "r_deg_s", "runs", "diverged",
           "imo_percent", "coverage", "named", "parameters", "seconds", "memory_mb",
           "ratio_to_best", "reference", "cannot", "settings", "program")
TEXTS = ("data", "task", "kind", "prediction", "peer", "named", "cannot", "settings", "program")


def with_ratios(rows):
    """Adds the ratio of each standardised error to the least one of the same task."""
    for row in rows:
        alike = [other["standardised_error"] for other in rows
                 if same_task(row, other) and is_compared(other)]
        row["ratio_to_best"] = (row["standardised_error"] / max(min(alike), 1e-12)
                                if is_compared(row) else None)
    return rows


def is_compared(row):
    """Whether a row has an error, and not that of the very model that made the data."""
    return row.get("standardised_error") is not None and not row.get("reference")


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


def read_rows(folder):
    """Rows of a folder's `results.csv`, empty cells left out; none without that file."""
    path = os.path.join(folder, "results.csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return [{name: cell_value(name, text) for name, text in row.items() if text}
                for row in csv.DictReader(file)]


def cell_value(name, text):
    if name in TEXTS:
        return text
    if name == "reference":
        return text == "True"
    return float(text) if "." in text or "e" in text else int(text)


def markdown(rows, about):
    peers = list(dict.fromkeys(row["peer"] for row in rows))
    return "\n".join([*losses(rows), "", *error_table(rows), "", *cost_table(rows, peers),
                      "", *diagnosis_table(rows), *refusals(rows), *machine(rows, about), ""])


def error_table(rows, ours="sistership"):
    """Standardised errors of each task: the program's, its ratio to the best of the others, and
    those of the others from the least on; in brackets those of the model that made the data."""
    lines = ["| data | task | prediction | sistership | by the best other | others |",
             "| --- | --- | --- | --: | --: | --- |"]
    for key in dict.fromkeys((r["data"], r["task"], r["prediction"]) for r in rows):
        alike = [r for r in rows if (r["data"], r["task"], r["prediction"]) == key
                 and r.get("standardised_error") is not None]
        own = [r for r in alike if r["peer"] == ours]
        others = sorted((r for r in alike if not r["peer"].startswith(ours)),
                        key=lambda r: r["standardised_error"])
        compared = [r["standardised_error"] for r in others if is_compared(r)]
        if not alike:
            continue
        ratio = "-"
        if own and compared:
            ratio = f"{own[0]['standardised_error'] / max(compared[0], 1e-12):.2f}"
        texts = [f"{r['peer']} {error(r)}" if is_compared(r) else f"({r['peer']} {error(r)})"
                 for r in others]
        lines.append(f"| {' | '.join(key)} | {error(own[0]) if own else '-'} | {ratio} | "
                     f"{', '.join(texts)} |")
    return lines


def error(row):
    """Standardised error, with the share of runs that diverged."""
    text = significant(row["standardised_error"])
    return text + (f" [{row['diverged']:.0%} diverged]" if row["diverged"] else "")


def significant(value):
    if value is None:
        return "-"
    if isinstance(value, int) or abs(value) >= 100:
        return f"{value:.0f}"
    digits = max(0, 2 - math.floor(math.log10(abs(value)))) if value else 0
    return f"{value:.{digits}f}"


def losses(rows, ours="sistership"):
    """Rows in which another peer has less error than ours, the worst first."""
    worse = sorted((r for r in rows if r["peer"] == ours and (r.get("ratio_to_best") or 0) > 1),
                   key=lambda r: -r["ratio_to_best"])
    worse = [r for r in worse if not best_of(rows, r)["peer"].startswith(ours)]
    lines = ["| where the default call loses | error by that of the best | best | selected |",
             "| --- | --: | --- | --- |"]
    return lines + [f"| {r['data']}, {r['task']}, {r['prediction']} | {r['ratio_to_best']:.2f} | "
                    f"{best_of(rows, r)['peer']} | {r['settings']} |" for r in worse]


def best_of(rows, row):
    """The row with the least error of the same task."""
    alike = [r for r in rows if same_task(r, row) and is_compared(r)]
    return min(alike, key=lambda r: r["standardised_error"])


def diagnosis_table(rows):
    """Effects that were named in trials with a hidden effect; empty without such a task."""
    found = [row for row in rows if row["prediction"] == "diagnosis"]
    if not found:
        return []
    lines = ["| data | hidden effect | peer | named | seconds |", "| --- | --- | --- | --- | --: |"]
    return [*lines, *(f"| {row['data']} | {row['task'].removeprefix('hidden-')} | {row['peer']} | "
                      f"{row['named']} | {significant(row['seconds'])} |" for row in found), ""]


def cost_table(rows, peers):
    """What each peer needs and how often it is best, over all tasks that it can do."""
    lines = ["| peer | tasks | best | geometric mean of the ratio to the best | runs diverged "
             "| error of IMO figures, % | headings in the 95 % band | parameters | seconds | MB |",
             "| --- |" + " --: |" * 9]
    for peer in peers:
        done = [r for r in rows if r["peer"] == peer and is_compared(r)]
        if not done:
            lines.append(f"| {peer} | 0 |" + " - |" * 8)
            continue
        ratio = math.exp(sum(math.log(max(r["ratio_to_best"], 1e-12)) for r in done) / len(done))
        share = sum(r["diverged"] * r["runs"] for r in done) / sum(r["runs"] for r in done)
        best = sum(r["ratio_to_best"] < 1.0000001 for r in done)
        cells = [mean(done, "imo_percent", 1), mean(done, "coverage", 100)]
        cells += [spread(r.get(name) for r in done) for name in ("parameters", "seconds", "memory_mb")]
        lines.append(f"| {peer} | {len(done)} | {best} | {ratio:.2f} | {share:.1%} | "
                     + " | ".join(cells) + " |")
    return lines


def mean(rows, name, factor):
    """Mean of a metric over the rows that have it."""
    found = [row[name] * factor for row in rows if row.get(name) is not None]
    return f"{sum(found) / len(found):.0f}" if found else "-"


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


def machine(rows, about):
    families = [f"{family} {', '.join(map(' '.join, packages.items()))}".strip()
                for family, packages in about["versions"].items()]
    programs = ", ".join(sorted({row["program"] for row in rows if row.get("program")}))
    return ["", f"{about['date']}, {about['machine']}, {about['cores']} cores, one process at a "
            f"time; {programs or 'no program'}; Python {about['python']}; {'; '.join(families)}; "
            f"seeds: 1 for every peer, those in the names of made ships."]


def write_page(folder, page):
    """Replaces the tables of a page by those of a folder of results, and puts its CSV beside it."""
    with open(os.path.join(folder, "results.json")) as file:
        about = json.load(file)["about"]
    with open(page) as file:
        head, _, rest = file.read().partition("<!-- results -->\n")
    _, end, tail = rest.partition("<!-- end of results -->")
    if not end:
        raise SystemExit(f"error: {page}: no lines <!-- results --> and <!-- end of results -->")
    tables = markdown(with_ratios(read_rows(folder)), about)
    with open(page, "w") as file:
        file.write(f"{head}<!-- results -->\n{tables}{end}{tail}")
    shutil.copy(os.path.join(folder, "results.csv"), os.path.splitext(page)[0] + ".csv")


if __name__ == "__main__":
    write_page(*sys.argv[1:])

"use strict";
// A job that goes on: its progress as it is told, and the page anew at its end.
for (const job of document.querySelectorAll("[data-job]")) {
  const events = new EventSource("/v1/jobs/" + job.dataset.job + "/events");
  events.addEventListener("job", (event) => {
    const now = JSON.parse(event.data);
    const bar = job.querySelector("progress"), words = job.querySelector("[data-words]");
    if (bar && now.state === "running") bar.value = now.progress;
    if (words) words.textContent = (job.dataset[now.state] ?? now.state) + ", " + Math.round(100 * now.progress) + " %" + (now.message ? ": " + now.message : "");
    if (!["queued", "running"].includes(now.state)) { events.close(); location.reload(); }
  });
}
// Sliders say their value; a form marked live is answered while it is changed.
const said = (slider) => {
  const output = document.querySelector("output[for='" + slider.id + "']");
  const mark = document.documentElement.lang === "en" ? "." : ",";
  if (output) output.textContent = slider.value.replace(".", mark);
};
for (const slider of document.querySelectorAll("input[type=range]")) {
  slider.addEventListener("input", () => said(slider));
  said(slider);
}
for (const form of document.querySelectorAll("form[data-live]")) {
  let waiting, latest = 0;
  const ask = async () => {
    const query = "?" + new URLSearchParams(new FormData(form)), turn = ++latest;
    const answer = await fetch(form.getAttribute("action") + query);
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    const result = page.getElementById("result");
    if (turn !== latest || !result) return;
    document.getElementById("result").replaceWith(result);
    document.dispatchEvent(new Event("content"));
    history.replaceState(null, "", query);
  };
  form.addEventListener("input", () => { clearTimeout(waiting); waiting = setTimeout(ask, 250); });
}
// Two clicks on a plot of channels name the range of an upload that is to be excluded or restored.
for (const figure of document.querySelectorAll("figure[data-trial]")) {
  const plot = figure.querySelector("svg"), of = figure.dataset, field = (name) => document.getElementById("range_" + name);
  let first = null;
  plot.addEventListener("click", (event) => {
    const box = plot.getBoundingClientRect(), scale = of.width / box.width;
    const share = ((event.clientX - box.left) * scale - of.left) / (of.right - of.left);
    const time = Number(of.from) + Math.min(1, Math.max(0, share)) * (of.to - of.from);
    const channel = of.channels.split(" ")[Math.floor((event.clientY - box.top) * scale / of.panel)];
    const known = [...field("channel").options].some((option) => option.value === channel);
    const ends = first === null ? [time, time] : [Math.min(first, time), Math.max(first, time)];
    first = first === null ? time : null;
    field("trial").value = of.trial;
    if (known) field("channel").value = channel;
    [field("from").value, field("to").value] = ends.map((end) => end.toFixed(1));
  });
}
// A field for a model offers names with the turning circle of each, while one types.
for (const field of document.querySelectorAll("input[list=models]")) {
  const names = [...field.list.options].map((option) => option.value), box = document.createElement("ul");
  let at = -1;
  Object.assign(box, { id: field.id + "-offers", className: "offers", role: "listbox", hidden: true, ariaLabel: field.list.dataset.label });
  Object.assign(field, { role: "combobox", autocomplete: "off", ariaExpanded: "false", ariaAutoComplete: "list" });
  field.setAttribute("aria-controls", box.id);
  field.removeAttribute("list");
  field.parentElement.append(box);
  const mark = (place) => {
    at = place;
    [...box.children].forEach((item, index) => { item.ariaSelected = String(index === at); });
    if (at < 0) field.removeAttribute("aria-activedescendant");
    else { field.setAttribute("aria-activedescendant", box.children[at].id); box.children[at].scrollIntoView({ block: "nearest" }); }
  };
  const open = (shown) => { box.hidden = !shown; field.ariaExpanded = String(shown); mark(-1); };
  const choose = (name) => { field.value = name; field.dispatchEvent(new Event("input", { bubbles: true })); open(false); };
  const offer = (name, index) => {
    const item = document.createElement("li"), turn = new Image(36, 36);
    Object.assign(turn, { loading: "lazy", alt: "", src: "/ships/" + name + "/turn.svg" });
    turn.addEventListener("error", () => { turn.style.visibility = "hidden"; });
    Object.assign(item, { id: box.id + index, role: "option", ariaSelected: "false" });
    item.append(turn, name);
    item.addEventListener("mousedown", (event) => { event.preventDefault(); choose(name); });
    return item;
  };
  const show = () => {
    const typed = field.value.trim().toLowerCase(), found = names.filter((name) => name.includes(typed));
    box.replaceChildren(...found.slice(0, 12).map(offer));
    open(found.length > 0 && document.activeElement === field);
  };
  field.addEventListener("input", show);
  field.addEventListener("click", show);
  field.addEventListener("blur", () => open(false));
  field.addEventListener("keydown", (event) => {
    const last = box.children.length - 1;
    if (event.key === "ArrowDown" && box.hidden) show();
    else if (event.key === "ArrowDown") mark(Math.min(at + 1, last));
    else if (event.key === "ArrowUp") mark(Math.max(at - 1, -1));
    else if (event.key === "Enter" && !box.hidden && at >= 0) choose(box.children[at].textContent);
    else if (event.key === "Escape" && !box.hidden) open(false);
    else return;
    event.preventDefault();
  });
}

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

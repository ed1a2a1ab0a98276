// Full runs: queue, progress, cancel, results. The state lives on the server; this page only shows it.
import { element, get, post, tell } from "/assets/server.js";

const WORDS = { waiting: "waiting", running: "running", cancelling: "stopping", done: "done", failed: "failed", cancelled: "cancelled", lost: "process lost" };
const TONES = { done: "good", failed: "bad", lost: "bad", cancelled: "caution" };
const listeners = new Set();
let known = [], timer = 0;

export async function watchJobs() {
  clearTimeout(timer);
  try {
    known = (await get("/api/jobs")).jobs;
  } catch (refused) {
    tell(refused.message);
  }
  const running = known.find((job) => job.state === "running" || job.state === "cancelling"), waiting = known.filter((job) => job.state === "waiting").length;
  document.getElementById("jobs-link").textContent = running
    ? `Jobs: ${Math.round(100 * running.fraction)} %${waiting ? `, ${waiting} waiting` : ""}` : `Jobs${known.length ? ` (${known.length})` : ""}`;
  for (const listen of listeners) listen(known);
  timer = setTimeout(watchJobs, running || waiting ? 700 : 4000);
}

async function act(address) {
  await post(address);
  await watchJobs();
}

function row(job) {
  const active = job.state === "running" || job.state === "cancelling";
  const button = (words, address) => element("button", { type: "button", onclick: () => act(address) }, words);
  const progress = job.stage ? `${job.stage}: ${Math.round(100 * job.fraction)} %${job.left ? `, ${job.left} left` : ""}` : "starting";
  return element("li", { class: "job", "data-job": job.id, "data-state": job.state },
    element("div", { class: "job-head" },
      element("strong", {}, job.kind === "paper" ? `Paper: ${job.name}` : job.name),
      element("span", { class: `job-state ${TONES[job.state] || ""}` }, WORDS[job.state]),
      element("span", { class: "quiet" }, job.seconds ? `${job.seconds.toFixed(0)} s` : ""), element("span", { class: "spring" }),
      active && job.state === "running" || job.state === "waiting" ? button("Cancel", `/api/jobs/${job.id}/cancel`) : null,
      ["failed", "cancelled", "lost"].includes(job.state) ? button("Start again", `/api/jobs/${job.id}/again`) : null),
    active ? element("progress", { max: 1, value: job.fraction, "aria-label": "Progress" }) : null,
    element("p", { class: "quiet" }, active ? progress : job.words),
    job.files.length ? element("p", { class: "job-files" },
      job.files.includes("report.html") ? element("a", { href: `#/job/${job.id}` }, "Report") : null,
      ...job.files.map((name) => element("a", { href: `/results/${job.id}/${name}?download`, download: true }, name))) : null,
    element("p", { class: "quiet command" }, element("code", {}, job.command), " in ", element("span", {}, job.folder)));
}

export function showJobs(content) {
  const list = element("ul", { class: "jobs" }), empty = element("p", { class: "quiet" }, "No job was started. Open a case and press Run.");
  content.replaceChildren(element("h1", {}, "Jobs"), empty, list);
  let last = "";
  const show = (jobs) => {
    const state = JSON.stringify(jobs);
    if (state === last) return;
    last = state;
    const held = document.activeElement?.closest?.("[data-job]")?.dataset.job, words = document.activeElement?.textContent;
    empty.hidden = jobs.length > 0;
    list.replaceChildren(...jobs.map(row));
    if (held) [...list.querySelectorAll(`[data-job="${held}"] button`)].find((one) => one.textContent === words)?.focus();
  };
  listeners.add(show);
  show(known);
  watchJobs();
  return { close: () => listeners.delete(show) };
}

export function showJob(content, key) {
  const frame = element("iframe", { src: `/results/${key}/report.html`, title: "Report of the run", sandbox: "allow-scripts allow-downloads allow-modals" });
  content.replaceChildren(element("p", { class: "job-files" }, element("a", { href: "#/jobs" }, "All jobs"),
    ...["report.html", "report.xlsx", "results.nc", "case.yaml"].map((name) => element("a", { href: `/results/${key}/${name}?download`, download: true }, name))), frame);
  return {};
}

// Full runs: queue, progress, cancel, results. The state lives on the server; this page only shows it.
import { element, get, post, say, tell } from "/assets/server.js";

const WORDS = { waiting: say("waiting"), running: say("running"), cancelling: say("stopping"), done: say("done"), failed: say("failed"), cancelled: say("cancelled"), lost: say("process lost") };
const KINDS = { study: say("Study"), fit: say("Fit"), paper: say("Paper") };
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
    ? `${say("Jobs")}: ${Math.round(100 * running.fraction)} %${waiting ? say(", {0} waiting", waiting) : ""}` : `${say("Jobs")}${known.length ? ` (${known.length})` : ""}`;
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
  const progress = job.stage ? `${job.stage}: ${Math.round(100 * job.fraction)} %${job.left ? say(", {0} left", job.left) : ""}` : say("starting");
  return element("li", { class: "job", "data-job": job.id, "data-state": job.state },
    element("div", { class: "job-head" },
      element("strong", {}, job.kind === "run" ? job.name : `${KINDS[job.kind]}: ${job.name}`),
      element("span", { class: `job-state ${TONES[job.state] || ""}` }, WORDS[job.state]),
      element("span", { class: "quiet" }, job.seconds ? `${job.seconds.toFixed(0)} s` : ""), element("span", { class: "spring" }),
      active && job.state === "running" || job.state === "waiting" ? button(say("Cancel"), `/api/jobs/${job.id}/cancel`) : null,
      ["failed", "cancelled", "lost"].includes(job.state) ? button(job.kind === "study" ? say("Go on") : say("Start again"), `/api/jobs/${job.id}/again`) : null),
    active ? element("progress", { max: 1, value: job.fraction, "aria-label": say("Progress") }) : null,
    element("p", { class: "quiet" }, active ? progress : job.words),
    job.files.length ? element("p", { class: "job-files" },
      job.files.includes("report.html") ? element("a", { href: `#/job/${job.id}` }, say("Report")) : null,
      ...job.files.map((name) => element("a", { href: `/results/${job.id}/${name}?download`, download: true }, name))) : null,
    job.kind === "study" && !["waiting"].includes(job.state) ? element("p", { class: "job-files" }, element("a", { href: `#/job/${job.id}` }, say("Table of the cases"))) : null,
    commandOf(job));
}

function commandOf(job) {
  const copy = element("button", { type: "button", onclick: async () => { await navigator.clipboard.writeText(job.command); tell(say("copied")); } }, say("Copy"));
  return element("p", { class: "quiet command" }, element("code", {}, job.command), " ", copy);
}

export function showJobs(content) {
  const list = element("ul", { class: "jobs" }), empty = element("p", { class: "quiet" }, say("No job was started. Open a case and press Run."));
  content.replaceChildren(element("h1", {}, say("Jobs")), empty, list);
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
  const head = element("div", { class: "job-files" }), table = element("div", { class: "study" }), frame = element("iframe", { title: say("Report of the run"), sandbox: "allow-scripts allow-downloads allow-modals" });
  let shown = "", counted = -1;
  content.replaceChildren(head, table, frame);
  const show = async (jobs) => {
    const job = jobs.find((one) => one.id === key);
    if (!job) return;
    const done = job.files.includes("report.html"), active = job.state === "running" || job.state === "cancelling";
    const state = JSON.stringify([job.files, job.state]);
    if (state !== shown) {
      shown = state;
      head.replaceChildren(element("a", { href: "#/jobs" }, say("All jobs")), ...job.files.map((name) => element("a", { href: `/results/${key}/${name}?download`, download: true }, name)));
      if (done && !active) frame.src = `/results/${key}/report.html`;
      frame.hidden = !done || active;
    }
    if (job.kind !== "study") return;
    const found = await get(`/api/jobs/${key}/study`).catch(() => null);
    if (!found || (found.ended === counted && !active)) return;
    if (found.ended !== counted) {
      counted = found.ended;
      showStudy(table, key, found);
      if (active && found.gathered) { frame.hidden = false; frame.src = `/results/${key}/so_far.html`; }
    }
  };
  listeners.add(show);
  show(known);
  watchJobs();
  return { close: () => listeners.delete(show) };
}

// The cases of a study that have ended: labels, status, what differs most; a click opens the case.
function showStudy(place, key, found) {
  const open = async (index) => { const opened = await post(`/api/jobs/${key}/cases`, { case: index }); location.hash = `#/case/${opened.id}`; };
  const head = [say("Case"), ...found.axes, say("Status"), ...found.columns.map((one) => `${one.words}${one.unit ? ` [${one.unit}]` : ""}`)];
  const rows = found.rows.map((row) => element("tr", {},
    element("td", {}, element("button", { type: "button", title: say("Open this case"), onclick: () => open(row.case) }, `${row.case}`)),
    ...found.axes.map((_, at) => element("td", {}, row.labels[at] ?? "")), element("td", { title: row.message }, row.status),
    ...row.values.map((value) => element("td", { class: "number" }, value === null || value === undefined ? "" : shortNumber(value)))));
  place.replaceChildren(element("p", { class: "quiet" }, [say("{0} of {1} cases have ended", found.ended, found.total), found.ended > found.rows.length ? say("the first {0} are shown", found.rows.length) : "", say("the number of a case opens it")].filter(Boolean).join(say("; "))),
    element("div", { class: "study-table" }, element("table", {}, element("thead", {}, element("tr", {}, ...head.map((word) => element("th", { scope: "col" }, word)))), element("tbody", {}, ...rows))));
}

const shortNumber = (value) => (Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(3) : String(Number(value.toPrecision(4)))).replace("-", "\u2212");

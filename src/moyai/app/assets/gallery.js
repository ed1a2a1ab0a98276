// Cards: open cases, case files of the folder, a template of each kind, the five papers.
import { element, get, post, say } from "/assets/server.js";

const SHAPES = {
  breakwater: "M10 30h26v-14h-26zM10 30Q4 46 -8 52M36 30Q42 46 54 52",
  curtain: "M22 12v2a4 4 0 0 1 0 8v0q10 14 2 28M22 22q-2 14 2 28",
  cage: "M6 16h34M8 16l3 24h24l3-24M11 40l12 8l12-8",
  network: "M36 12a5 5 0 1 1-.1 0M34 21Q30 46 4 52",
  units: "M-4 12h16v10h-16zM16 12h16v10h-16zM36 12h16v10h-16zM12 17h4M32 17h4M-4 22Q-6 44 -11 53M52 22Q54 44 58 53",
  member: "M4 28h38M4 36h38M4 28a2 4 0 0 0 0 8M42 28a2 4 0 0 1 0 8",
};

function drawing(kind) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  made.setAttribute("viewBox", "-12 0 70 56");
  made.setAttribute("aria-hidden", "true");
  for (const [d, name] of [["M-12 16h70", "surface"], ["M-12 53h70", "bed-line"], [SHAPES[kind] || "", "mooring"]]) {
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", d);
    path.setAttribute("class", name);
    made.append(path);
  }
  return made;
}

const JOBS = ["study", "fit"];

async function open(what) {
  const opened = await post("/api/cases", what);
  location.hash = `#/case/${opened.id}`;
}

async function startFile(file) {
  const job = await post("/api/jobs", { file });
  location.hash = job.kind === "study" ? `#/job/${job.id}` : "#/jobs";
}

async function startPaper(paper) {
  await post("/api/jobs", { paper });
  location.hash = "#/jobs";
}

function card(kind, title, detail, act) {
  return element("li", {}, element("button", { class: "card", type: "button", onclick: act }, kind ? drawing(kind) : null,
    element("span", { class: "card-title" }, title), element("span", { class: "card-detail" }, detail)));
}

function group(title, cards, empty = "") {
  if (!cards.length && !empty) return null;
  return element("section", {}, element("h2", {}, title), cards.length ? element("ul", { class: "cards" }, ...cards) : element("p", { class: "quiet" }, empty));
}

// A file by its name: one that lies deeper than the list goes.
function opening(files) {
  const name = element("input", { type: "text", list: "files-known", required: true, spellcheck: "false", "aria-label": say("Case file of this folder"), placeholder: "case.yaml" });
  const act = (event) => { event.preventDefault(); open({ file: name.value.trim() }); };
  return element("form", { class: "open-file", onsubmit: act }, name, element("datalist", { id: "files-known" }, ...files.map((one) => element("option", { value: one.file }))), element("button", {}, say("Open")));
}

export async function showGallery(content) {
  const found = await get("/api/gallery");
  const parts = [
    element("h1", {}, say("Cases")),
    element("p", { class: "subtitle" }, found.folder),
    opening(found.files.filter((one) => !JOBS.includes(one.kind))),
    group(say("Open now"), found.recent.map((one) => card("", one.file, say("as you left it"), () => { location.hash = `#/case/${one.id}`; }))),
    group(say("In this folder"), found.files.filter((one) => !JOBS.includes(one.kind)).map((one) => card(one.kind, one.title, one.file, () => open({ file: one.file }))), say("no case files in this folder yet")),
    group(say("Studies and fits, run as jobs"), found.files.filter((one) => JOBS.includes(one.kind)).map((one) => card("", one.title, `${one.kind === "fit" ? say("fit") : say("study")}: ${one.file}`, () => startFile(one.file)))),
    group(say("Templates"), found.templates.map((one) => card(one.kind, one.name, one.title, () => open({ template: one.template })))),
    group(say("Papers, computed again as a job"), found.papers.map((one) => card(one.kind, `${one.authors} (${one.year})`, one.line, () => startPaper(one.paper)))),
  ];
  content.replaceChildren(...parts.filter(Boolean));
}

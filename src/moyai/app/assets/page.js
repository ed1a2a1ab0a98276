// The page: which view is shown follows the address behind the #, so that reload, back and two tabs work.
import { CaseView } from "/assets/case.js";
import { showGallery } from "/assets/gallery.js";
import { showJob, showJobs, watchJobs } from "/assets/jobs.js";
import { element, post, say, tell } from "/assets/server.js";

const content = document.getElementById("content");
let view = null;

async function show() {
  const [, where = "", key = ""] = location.hash.split("/");
  if (view && view.close) view.close();
  view = null;
  content.replaceChildren(element("p", { class: "quiet" }, say("loading …")));
  content.className = where || "gallery";
  try {
    if (where === "case") { view = new CaseView(content, key); await view.open(); }
    else if (where === "jobs") view = showJobs(content);
    else if (where === "job") view = showJob(content, key);
    else await showGallery(content);
  } catch (refused) {
    content.replaceChildren(
      element("p", { class: "notice error" }, element("strong", {}, say("Error")), element("span", {}, refused.message)),
      element("p", {}, element("a", { href: "#/" }, say("To the cases"))),
    );
  }
}

window.addEventListener("hashchange", show);
window.addEventListener("unhandledrejection", (event) => tell(event.reason.message || String(event.reason)));
watchJobs();
if (!location.hash && document.querySelector("meta[name=moyai-first]").content) {
  post("/api/cases", {}).then((opened) => location.replace(`#/case/${opened.id}`), (refused) => { tell(refused.message); show(); });
} else show();

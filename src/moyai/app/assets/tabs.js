// Three ways to change a case. Wide: the text stays, numbers and form change places above it. Narrow: one of the three.
import { element, say } from "/assets/server.js";

// Return the list of tabs; `chosen` is called with the name of the one that is shown.
export function tabs(chosen) {
  const names = [["numbers", say("Numbers")], ["form", say("Form")], ["written", say("Text")]];
  const list = element("div", { class: "tabs", role: "tablist", "aria-label": say("Ways to change the case") });
  let shown = "";
  const choose = (name, focus) => {
    for (const button of list.children) {
      const mine = button.dataset.tab === name;
      button.setAttribute("aria-selected", String(mine));
      button.tabIndex = mine ? 0 : -1;
      if (mine && focus) button.focus();
    }
    chosen(shown = name);
  };
  list.append(...names.map(([name, words]) => element("button", { type: "button", role: "tab", "data-tab": name, onclick: () => choose(name) }, words)));
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key], at = names.findIndex(([name]) => name === shown);
    if (step) choose(names[(at + step + names.length) % names.length][0], true);
  });
  choose("numbers");
  return list;
}

// The text of a case in CodeMirror: colours of YAML, errors under their words, search, completion of keys from the schema.
import * as cm from "/assets/codemirror.js";
import { faultWords, say } from "/assets/server.js";

const COLOURS = cm.HighlightStyle.define([
  { tag: [cm.tags.propertyName, cm.tags.definition(cm.tags.propertyName)], color: "var(--accent)" },
  { tag: cm.tags.comment, color: "var(--muted)", fontStyle: "italic" },
  { tag: [cm.tags.string, cm.tags.content], color: "var(--ink)" },
  { tag: [cm.tags.keyword, cm.tags.labelName, cm.tags.typeName], color: "var(--caution)" },
  { tag: [cm.tags.punctuation, cm.tags.separator, cm.tags.squareBracket, cm.tags.brace], color: "var(--muted)" },
]);

// What the search of the editor says of itself, by the words that it asks for
const PHRASES = {
  Find: say("Find"), Replace: say("Replace"), next: say("next"), previous: say("previous"), all: say("all"), "match case": say("match case"), regexp: say("regexp"),
  "by word": say("by word"), replace: say("replace"), "replace all": say("replace all"), close: say("close"), "Go to line": say("Go to line"), go: say("go"),
  "current match": say("current match"), "on line": say("on line"), "replaced match on line $": say("replaced match on line $"), "replaced $ matches": say("replaced $ matches"),
  "Completions": say("Completions"), "Fold line": say("Fold line"), "Unfold line": say("Unfold line"), "No diagnostics": say("No diagnostics"), Diagnostics: say("Diagnostics"),
};

export class CodeText {
  constructor({ changed, undo, keysAt }) {
    this.quiet = false;
    // Undo is that of the case, across form, sliders and text: the editor keeps no history of its own
    const keys = [{ key: "Mod-z", run: () => { undo(); return true; } }, ...cm.completionKeymap, ...cm.searchKeymap, ...cm.foldKeymap, ...cm.defaultKeymap];
    this.view = new cm.EditorView({ extensions: [
      cm.lineNumbers(), cm.foldGutter(), cm.highlightActiveLine(), cm.highlightActiveLineGutter(), cm.drawSelection(), cm.bracketMatching(), cm.highlightSelectionMatches(),
      cm.indentUnit.of("  "), cm.yaml(), cm.syntaxHighlighting(COLOURS), cm.lintGutter(), cm.search({ top: true }), cm.EditorState.phrases.of(PHRASES),
      cm.autocompletion({ override: [(context) => complete(context, keysAt)], icons: false }), cm.keymap.of(keys),
      cm.EditorView.contentAttributes.of({ "aria-label": say("Case file (YAML)"), "aria-describedby": "faults", spellcheck: "false", autocapitalize: "off" }),
      cm.EditorView.updateListener.of((update) => { if (update.docChanged && !this.quiet) changed(); }),
    ] });
    this.element = document.createElement("div");
    this.element.className = "editor code";
    this.element.append(this.view.dom);
  }
  get text() { return this.view.state.doc.toString(); }
  set text(text) {
    this.quiet = true;
    this.put(text);
    this.quiet = false;
  }
  type(text) { this.put(text); }
  put(next) {
    const now = this.view.state.doc.toString();
    if (next === now) return;
    let from = 0, tail = 0;
    const most = Math.min(now.length, next.length);
    while (from < most && now[from] === next[from]) from++;
    while (tail < most - from && now[now.length - 1 - tail] === next[next.length - 1 - tail]) tail++;
    this.view.dispatch({ changes: { from, to: now.length - tail, insert: next.slice(from, next.length - tail) } });
  }
  mark(faults, warnings) {
    const found = [...faults.map((one) => [one, "error"]), ...warnings.map((one) => [one, "warning"])];
    const marks = found.filter(([one]) => one.line).map(([one, severity]) => ({ ...this.place(one), severity, message: faultWords(one) }));
    marks.sort((a, b) => a.from - b.from);
    this.quiet = true;
    this.view.dispatch(cm.setDiagnostics(this.view.state, marks));
    this.quiet = false;
    this.view.contentDOM.setAttribute("aria-invalid", String(faults.length > 0));
  }
  place({ line, column }) {
    const { doc } = this.view.state, at = doc.line(Math.min(line, doc.lines)), from = Math.min(at.from + Math.max(0, column - 1), at.to);
    const word = /^[^\s,}\]#]+(?: [\w/]+)?/.exec(doc.sliceString(from, at.to));
    return { from, to: word ? from + word[0].length : at.to };
  }
  jump(line, column) {
    const { from } = this.place({ line, column });
    this.view.dispatch({ selection: { anchor: from }, effects: cm.EditorView.scrollIntoView(from, { y: "center" }) });
    this.view.focus();
  }
}

// Keys that the block at the cursor lacks, by the indents of the lines above it.
async function complete(context, keysAt) {
  const line = context.state.doc.lineAt(context.pos), before = line.text.slice(0, context.pos - line.from);
  const typed = /^([ ]*(?:- )?)(\w*)$/.exec(before);
  if (!typed || (!typed[2] && !context.explicit)) return null;
  const options = await keysAt(blockAt(context.state.doc, line.number, typed[1].length));
  return options.length ? { from: context.pos - typed[2].length, options: options.map((one) => ({ label: one.key, apply: `${one.key}: `, info: one.help || undefined })), validFor: /^\w*$/ } : null;
}

export function blockAt(doc, number, indent) {
  const path = [];
  let entry = null;
  for (let n = number - 1, depth = indent; n > 0 && depth > 0; n--) {
    const found = /^([ ]*)(- )?([\w]+):/.exec(doc.line(n).text), dash = /^([ ]*)- /.exec(doc.line(n).text);
    if (dash && dash[1].length < depth) {
      const inside = dash[1].length + 2 === depth || entry === null;
      if (inside) { entry = 0; for (let m = n - 1; m > 0; m--) { const other = /^([ ]*)(- )?/.exec(doc.line(m).text); if (!doc.line(m).text.trim()) continue; if (other[1].length < dash[1].length) break; if (other[2] && other[1].length === dash[1].length) entry++; } path.unshift(entry); depth = dash[1].length + (dash[1].length ? 0 : 1); }
    } else if (found && found[1].length + (found[2] ? 2 : 0) < depth) {
      path.unshift(found[3]);
      depth = found[1].length;
    }
  }
  return path;
}

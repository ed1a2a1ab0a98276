// Talk to the server: JSON with a version; every changing request carries the token of this page.
const VERSION = 1;
const words = JSON.parse(document.getElementById("app-words").textContent);
const token = document.querySelector("meta[name=moyai-token]").content;

// A sentence of the page in its language, with what belongs in its places; the server finds the sentences in these files.
export const say = (text, ...values) => (words[text] ?? text).replace(/\{(\d)\}/g, (_, place) => values[place]);

export class Refused extends Error {
  constructor(faults, status) {
    super(faults.map((fault) => faultWords(fault)).join("\n"));
    this.faults = faults;
    this.status = status;
  }
}

export const faultWords = (fault) =>
  [fault.path ? `${fault.path}: ${fault.message}` : fault.message, fault.allowed ? say("allowed: {0}", fault.allowed) : "", fault.remedy]
    .filter(Boolean).join("; ");

async function request(address, body) {
  const text = JSON.stringify(body), how = body === undefined ? {} : {
    method: "POST", body: text, keepalive: document.hidden && text.length < 60000, headers: { "Content-Type": "application/json", "X-Moyai-Token": token },
  };
  let answer;
  try {
    answer = await fetch(address, how);
  } catch {
    throw new Refused([{ message: say("the app has ended; start 'moyai app' again") }], 0);
  }
  if (!answer.ok && answer.headers.get("Content-Type") !== "application/json") throw new Refused([{ message: await answer.text() }], answer.status);
  return answer;
}

async function json(address, body) {
  const answer = await request(address, body), content = await answer.json();
  if (content.version !== VERSION) throw new Refused([{ message: say("page and server are of different versions: reload the page") }], 0);
  if (!answer.ok) throw new Refused(content.faults, answer.status);
  return content;
}

export const get = (address) => json(address);
export const post = (address, body = {}) => json(address, body);

// Call `take` with every line of an answer as soon as it is there.
export async function stream(address, body, take) {
  const answer = await request(address, body);
  if (!answer.ok) throw new Refused((await answer.json()).faults, answer.status);
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    const lines = (rest + value).split("\n");
    rest = lines.pop();
    for (const line of lines) if (line) take(JSON.parse(line));
  }
}

// Build elements without markup in texts: element("button", {class: "x", onclick: f}, "words", child)
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== null && value !== undefined) made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined && child !== ""));
  return made;
}

let timer = 0;
export function tell(words) {
  const place = document.getElementById("announcement");
  place.textContent = words;
  clearTimeout(timer);
  timer = setTimeout(() => { place.textContent = ""; }, 9000);
}

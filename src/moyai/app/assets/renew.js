// Turn what stands in the page into what is to stand there, node by node: what stays the same is not laid out again.
// Sections, panes and figures are known by their names, all else by its place.
const keyOf = ({ nodeName, id, dataset }) => (nodeName === "SECTION" ? id : dataset?.figure || dataset?.option || "");

// Make the element `old` like `fresh`. A fresh figure with `kept` stands for that figure, which stays as it is.
export function renewed(old, fresh) {
  if (old.isEqualNode(fresh)) return;
  for (const { name } of [...old.attributes]) if (!fresh.hasAttribute(name) && name !== "open") old.removeAttribute(name);
  for (const { name, value } of fresh.attributes) if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  renewedWithin(old, fresh);
}

export function renewedWithin(old, fresh) {
  const wanted = [...fresh.childNodes], names = new Set(wanted.map(keyOf));
  const known = new Map([...old.children].map((one) => [keyOf(one), one]));
  let at = old.firstChild;
  for (const one of wanted) {
    while (at && keyOf(at) && !names.has(keyOf(at))) at = gone(at);
    const found = keyOf(one) ? known.get(keyOf(one)) : likeFrom(at, one);
    const same = found && !one.kept && found.nodeName === one.nodeName && !one.dataset?.figure;
    if (same && !keyOf(one)) while (at !== found) at = gone(at);
    const stands = same ? found : one.kept ? one.kept.element : one;
    if (stands === at) at = at.nextSibling; else old.insertBefore(stands, at);
    if (!same) settle(stands);
    else if (one.nodeType === 1) renewed(stands, one);
    else if (stands.data !== one.data) stands.data = one.data;
  }
  while (at) at = gone(at);
}

// The next node of the kind of another, where it is near. A moving view is made anew.
function likeFrom(at, one) {
  for (let far = 0; at && far < 3 && !keyOf(at); far++, at = at.nextSibling) {
    if (at.nodeName === one.nodeName && at.classList?.[0] === one.classList?.[0] && !one.dataset?.scene) return at;
  }
  return null;
}

// Put the figures that stay into an element that is new.
export function settle(element) {
  for (const one of element.querySelectorAll?.("[data-figure]") || []) if (one.kept) one.replaceWith(one.kept.element);
}

function gone(node) {
  const next = node.nextSibling;
  node.remove();
  return next;
}

const frame = (spec) => JSON.stringify([spec.abscissae.map((one) => one.key), spec.panels.length, Boolean(spec.slider), spec.categories.length > 0]);
// Whether a figure can go on as another one of its name.
export const alike = (old, spec) => frame(old) === frame(spec);

export function renewFigure(figure, spec, element) {
  const zoomed = figure.range && JSON.stringify(figure.range) !== JSON.stringify(figure.spec.window || null);
  if (!zoomed) figure.range = undefined;
  figure.spec = spec;
  figure.cache.clear();
  figure.abscissa = spec.abscissae.find((one) => figure.abscissa && one.key === figure.abscissa.key) || spec.abscissae[0];
  renewed(figure.element.querySelector("figcaption"), element.querySelector("figcaption"));
}

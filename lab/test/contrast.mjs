// Contrasts by the colours that a browser computes.

/**
 * What is fainter in a page than level AA of WCAG 2.1 asks for: text below 4.5:1 (large text 3:1), edges of fields and colours of what is drawn below
 * 3:1. Surfaces of beams, whose axes are drawn over them, may be fainter. It runs in the page.
 */
export const faint = () => {
  const brush = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const known = new Map();
  const read = (colour) => known.get(colour) ?? known.set(colour, painted(colour)).get(colour);
  const painted = (colour) => {
    brush.clearRect(0, 0, 1, 1);
    brush.fillStyle = colour;
    brush.fillRect(0, 0, 1, 1);
    return [...brush.getImageData(0, 0, 1, 1).data].map((x) => x / 255);
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((x, i) => a * x + (1 - a) * below[i]);
  const light = (rgb) => rgb.slice(0, 3).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)).reduce((sum, x, i) => sum + x * [0.2126, 0.7152, 0.0722][i], 0);
  const ratio = (a, b) => {
    const [x, y] = [light(a), light(b)].sort((a, b) => b - a);
    return (x + 0.05) / (y + 0.05);
  };
  const behind = (node) => {
    const layers = [];
    for (let at = node; at; at = at.parentElement) layers.push(read(getComputedStyle(at).backgroundColor));
    return layers.reverse().reduce((below, layer) => over(layer, below), over(read("Canvas"), [1, 1, 1]));
  };
  const found = new Map();
  for (const node of document.querySelectorAll("body *")) {
    if (!node.checkVisibility({ opacityProperty: true, visibilityProperty: true }) || node.closest("[disabled], .u-legend, .stale")) continue;
    const style = getComputedStyle(node);
    const field = node.matches("input[type=text], input[type=search], select");
    const own = [...node.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim()) || field;
    const place = `${node.tagName.toLowerCase()}${node.id ? `#${node.id}` : ""}.${node.className?.baseVal ?? node.className}`;
    const below = behind(node);
    if (own) {
      const colour = over(read(node instanceof SVGElement ? style.fill : style.color), below);
      const size = parseFloat(style.fontSize);
      const least = size >= 24 || (size >= 18.66 && style.fontWeight >= 600) ? 3 : 4.5;
      const now = ratio(colour, below);
      if (now < least) found.set(place, `${place}: text ${now.toFixed(2)} (${node.textContent.slice(0, 30)})`);
    }
    if (field) {
      const now = ratio(over(read(style.borderTopColor), behind(node.parentElement)), behind(node.parentElement));
      if (now < 3) found.set(`${place}e`, `${place}: edge ${now.toFixed(2)}`);
    }
  }
  const paint = getComputedStyle(document.documentElement);
  const paper = read(paint.getPropertyValue("--paper")).slice(0, 3);
  for (const name of ["accent", "beam", "faint", "hub", "path", "obstacle", "x", "y", "z", "force", "curve0", "curve1", "curve2", "curve3", "curve4", "curve5", "good"]) {
    const now = ratio(read(paint.getPropertyValue(`--${name}`)).slice(0, 3), paper);
    if (now < 3) found.set(name, `--${name}: ${now.toFixed(2)}`);
  }
  return [...found.values()];
};

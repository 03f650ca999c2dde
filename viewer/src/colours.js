// Colours, those of muslin's pictures (src/muslin/render/colour.cpp): lightness of the map rises evenly.

const path = [
  [0.3, 0.045, -0.105], [0.425, -0.01, -0.105], [0.55, -0.075, -0.045],
  [0.675, -0.12, 0.04], [0.8, -0.105, 0.125], [0.925, -0.03, 0.165],
];

/** OKLab to linear sRGB (B. Ottosson, 2020). */
function linear([L, a, b]) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
  ];
}

const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/** sRGB bytes of t in 0…1. */
export function mapColour(t) {
  const place = Math.min(Math.max(t, 0), 1) * (path.length - 1);
  const i = Math.min(Math.floor(place), path.length - 2);
  const s = place - i;
  const lab = path[i].map((value, k) => (1 - s) * value + s * path[i + 1][k]);
  return linear(lab).map((x) => Math.round(255 * encode(Math.min(Math.max(x, 0), 1))));
}

export const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/** Of curves; colour-blind readers tell them apart (Okabe and Ito, 2008). */
export const curveColours = {
  kinetic: '#0072b2', elastic: '#e69f00', potential: '#009e73', work: '#cc79a7', dissipated: '#d55e00',
  balance: '#808080', max_stretch: '#b8443a', min_distance: '#5b7a8c',
};

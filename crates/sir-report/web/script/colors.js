// False colors.

/** Coefficients of 1, t, …, t⁶ in red, green and blue of viridis (polynomial of Zucker 2019, public domain). */
const VIRIDIS = [
  [0.2777273272, 0.0054073445, 0.3340998053],
  [0.1050930431, 1.4046135299, 1.3845901626],
  [-0.3308618287, 0.2148475595, 0.0950951630],
  [-4.6342304990, -5.7991009734, -19.3324409563],
  [6.2282699363, 14.1799333668, 56.6905526007],
  [4.7763849977, -13.7451453777, -65.3530326334],
  [-5.4354558559, 4.6458526122, 26.3124352496],
];

/** Luminance of the bands. */
const LUMINANCE = [0.2126, 0.7152, 0.0722];
const luminance = (r, g, b) => LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b;

/** Returns the color of a number from 0 to 1 as three bytes. */
function viridis(number) {
  const t = Math.min(1, Math.max(0, number));
  return [0, 1, 2].map((band) => {
    const sum = VIRIDIS.reduceRight((total, row) => total * t + row[band], 0);
    return Math.round(255 * Math.min(1, Math.max(0, sum)));
  });
}

const rgb = (bytes) => `rgb(${bytes.join(',')})`;

// Values of sides.

/** Returns reflected light: all light without direct light. */
const reflectedE = (all, direct) => (all - direct > ROUNDING * all ? all - direct : 0);

/** Returns functions that read the values of sides, with their names and units. */
function makeValues(mesh, facts) {
  const { light, surface, source, header } = mesh;
  const photometric = facts.units.power === 'lm';
  const unitOfB = photometric ? 'lm/m²' : 'W/m²';
  const quantity = facts.units.name.replace(/^./, (letter) => letter.toUpperCase());
  const meanE = (i) => luminance(light[i], light[i + 1], light[i + 2]);
  const bandsB = (i) => [0, 1, 2].map((k) => source[i + k] + surface[i + k] * light[i + k]);
  const kinds = {
    lit: { label: 'Lit', title: 'Lit', unit: '' },
    illuminance: { label: quantity, title: quantity, unit: facts.units.irradiance, of: meanE },
    radiosity: { label: 'Radiosity', title: photometric ? 'Radiosity (luminous exitance)' : 'Radiosity', unit: unitOfB, of: (i) => luminance(...bandsB(i)) },
    direct: { label: 'Direct', title: `Direct ${facts.units.name}`, unit: facts.units.irradiance, of: (i) => surface[i + 3], absent: !mesh.hasDirect },
    reflected: { label: 'Reflected', title: `Reflected ${facts.units.name}`, unit: facts.units.irradiance, of: (i) => reflectedE(meanE(i), surface[i + 3]), absent: !mesh.hasDirect },
    error: { label: 'Relative error', title: `Relative standard error of ${facts.units.name}`, unit: '%', of: (i) => (light[i + 3] > 0 && meanE(i) > 0 ? (100 * light[i + 3]) / meanE(i) : 0), absent: !mesh.hasError },
  };
  const known = {};

  /** Returns limits that leave out the lowest values, of sides with 2 % of the light, and the highest, of 2 % of the area. */
  function usualLimits(mode) {
    known[mode] ??= quantiles(mode);
    return known[mode];
  }

  function quantiles(mode) {
    const stride = Math.max(1, Math.floor(header.sides / 50000));
    const areas = logTable(header.logs.area);
    const list = [];
    const totals = [0, 0];
    for (let s = 0; s < header.sides; s += stride) {
      const [value, area] = [kinds[mode].of(4 * s), areas[mesh.area[s]]];
      const power = area * meanE(4 * s);
      if (value > 0 && power > 0 && value < Infinity) {
        list.push([value, power, area]);
        totals[0] += power;
        totals[1] += area;
      }
    }
    if (list.length === 0) return [0, 1];
    list.sort((a, b) => a[0] - b[0]);
    const quantile = (share, k) => {
      let sum = 0;
      const found = list.find(([, ...weights]) => (sum += weights[k]) >= share * totals[k]);
      return Number((found ?? list.at(-1))[0].toPrecision(3));
    };
    const [low, high] = [quantile(0.02, 0), quantile(0.98, 1)];
    return high > low * 1.001 ? [low, high] : [low * 0.5, high * 1.5];
  }

  /** Returns everything that is known about a side. */
  function ofSide(side) {
    const i = 4 * side;
    const material = header.materials[mesh.material[side]];
    return {
      object: cut(header.objects[mesh.object?.[side]] || '–'),
      material: cut(material?.name || '–'),
      patch: mesh.patch[side],
      triangle: mesh.triangle[side],
      bands: [light[i], light[i + 1], light[i + 2]],
      e: meanE(i),
      error: light[i + 3],
      b: luminance(...bandsB(i)),
    };
  }

  return { kinds, usualLimits, ofSide, unitE: facts.units.irradiance, unitB: unitOfB };
}

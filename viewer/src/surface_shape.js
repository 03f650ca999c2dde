// Computes smooth normals, stretch and bounds from the points of a surface. Arrays in, arrays out.

/**
 * Smooth normals, weighted by the angles of the corners so that they do not depend on how polygons were cut.
 * @param positions 3 × points
 * @param shape {triangles, points, normals, normalCount}: corners name drawn vertices, which name points and
 *   smooth normals
 * @param sums scratch, 3 × normalCount
 * @param out 3 × drawn vertices
 */
export function smoothNormals(positions, shape, sums, out) {
  const { triangles, points, normals } = shape;
  sums.fill(0);
  const add = (corner, weight, nx, ny, nz) => {
    const n = 3 * normals[corner];
    sums[n] += weight * nx;
    sums[n + 1] += weight * ny;
    sums[n + 2] += weight * nz;
  };
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * points[triangles[t]];
    const b = 3 * points[triangles[t + 1]];
    const c = 3 * points[triangles[t + 2]];
    const abx = positions[b] - positions[a], aby = positions[b + 1] - positions[a + 1],
      abz = positions[b + 2] - positions[a + 2];
    const acx = positions[c] - positions[a], acy = positions[c + 1] - positions[a + 1],
      acz = positions[c + 2] - positions[a + 2];
    const bcx = acx - abx, bcy = acy - aby, bcz = acz - abz;
    const nx = aby * acz - abz * acy, ny = abz * acx - abx * acz, nz = abx * acy - aby * acx;
    const area = Math.sqrt(nx * nx + ny * ny + nz * nz);
    if (!(area > 0)) continue;
    const angleA = Math.atan2(area, abx * acx + aby * acy + abz * acz);
    const angleB = Math.atan2(area, -(abx * bcx + aby * bcy + abz * bcz));
    add(triangles[t], angleA / area, nx, ny, nz);
    add(triangles[t + 1], angleB / area, nx, ny, nz);
    add(triangles[t + 2], (Math.PI - angleA - angleB) / area, nx, ny, nz);
  }
  for (let v = 0; v < points.length; ++v) {
    const n = 3 * normals[v];
    const length = Math.sqrt(sums[n] ** 2 + sums[n + 1] ** 2 + sums[n + 2] ** 2) || 1;
    out[3 * v] = sums[n] / length;
    out[3 * v + 1] = sums[n + 1] / length;
    out[3 * v + 2] = sums[n + 2] / length;
  }
}

/** Per point, the largest stretch of its edges in percent of their rest length; compression counts as 0. */
export function edgeStretch(positions, ends, restLengths, out) {
  out.fill(0);
  for (let e = 0; e < restLengths.length; ++e) {
    const a = ends[2 * e];
    const b = ends[2 * e + 1];
    const length = Math.hypot(positions[3 * a] - positions[3 * b], positions[3 * a + 1] - positions[3 * b + 1],
      positions[3 * a + 2] - positions[3 * b + 2]);
    const percent = 100 * (length / restLengths[e] - 1);
    if (percent > out[a]) out[a] = percent;
    if (percent > out[b]) out[b] = percent;
  }
}

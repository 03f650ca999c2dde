// One body on the stage: its surfaces, of which one is shown, moved to where the run has them.
import {
  BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, Group, LineBasicMaterial, LineSegments, Mesh, Vector2,
} from 'three';
import { clothMaterial, colourings } from './cloth_material.js';
import { roundUp } from './numbers.js';
import { edgeStretch, smoothNormals } from './surface_shape.js';

class Surface {
  constructor(run, description) {
    this.track = run.tracks[description.track];
    this.largestStretch = run.head.tracks[description.track].largest_stretch;
    this.shape = {
      triangles: run.indices(description.triangles),
      points: run.indices(description.points),
      normals: run.indices(description.normals),
    };
    this.ends = run.indices(description.ends);
    this.restLengths = run.floats(description.rest_lengths);
    this.positions = new Float32Array(3 * this.track.count);
    this.stretch = new Float32Array(this.track.count);
    this.sums = new Float32Array(3 * description.normal_count);
    const drawn = this.shape.points.length;
    const moving = (size) => new BufferAttribute(new Float32Array(size * drawn), size).setUsage(DynamicDrawUsage);
    this.geometry = new BufferGeometry();
    this.geometry.setIndex(new BufferAttribute(this.shape.triangles, 1));
    this.geometry.setAttribute('position', moving(3));
    this.geometry.setAttribute('normal', moving(3));
    this.geometry.setAttribute('stretch', moving(1));
    this.pattern = run.floats(description.pattern);
    this.geometry.setAttribute('pattern', new BufferAttribute(this.pattern, 2));
    // Edges share the points, not the drawn vertices.
    this.edges = new BufferGeometry();
    this.edges.setIndex(new BufferAttribute(this.ends, 1));
    this.edges.setAttribute('position', new BufferAttribute(this.positions, 3).setUsage(DynamicDrawUsage));
  }

  checks() {
    const low = [Infinity, Infinity];
    const high = [-Infinity, -Infinity];
    for (let i = 0; i < this.pattern.length; ++i) {
      low[i % 2] = Math.min(low[i % 2], this.pattern[i]);
      high[i % 2] = Math.max(high[i % 2], this.pattern[i]);
    }
    const extent = [Math.max(high[0] - low[0], 1e-9), Math.max(high[1] - low[1], 1e-9)];
    return {
      size: roundUp(Math.max(...extent) / 24), low: new Vector2(...low), extent: new Vector2(...extent),
    };
  }

  moveTo(place, withStretch) {
    this.track.read(place, this.positions);
    if (withStretch) edgeStretch(this.positions, this.ends, this.restLengths, this.stretch);
    const { position, normal, stretch } = this.geometry.attributes;
    const { points } = this.shape;
    for (let v = 0; v < points.length; ++v) {
      const p = 3 * points[v];
      position.array[3 * v] = this.positions[p];
      position.array[3 * v + 1] = this.positions[p + 1];
      position.array[3 * v + 2] = this.positions[p + 2];
      stretch.array[v] = this.stretch[points[v]];
    }
    smoothNormals(this.positions, this.shape, this.sums, normal.array);
    position.needsUpdate = normal.needsUpdate = stretch.needsUpdate = true;
    this.edges.attributes.position.needsUpdate = true;
  }
}

const black = new Color(0);

export class Body {
  constructor(run, description) {
    this.name = description.name;
    this.colour = description.colour;
    this.surfaces = {};
    for (const [kind, surface] of Object.entries(description.surfaces)) this.surfaces[kind] = new Surface(run, surface);
    this.material = clothMaterial(description, this.surfaces.skin.checks());
    this.mesh = new Mesh(this.surfaces.skin.geometry, this.material);
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.lines = new LineSegments(this.surfaces.skin.edges,
      new LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.35 }));
    this.lines.visible = false;
    for (const object of [this.mesh, this.lines]) object.frustumCulled = false;
    this.object = new Group();
    this.object.add(this.mesh, this.lines);
    this.kind = 'skin';
    this.edgesWanted = false;
  }

  get surface() {
    return this.surfaces[this.kind];
  }

  /** A body without that surface (a shell has only its skin) shows its skin. */
  showSurface(kind) {
    this.kind = this.surfaces[kind] ? kind : 'skin';
    this.mesh.geometry = this.surface.geometry;
    this.lines.geometry = this.surface.edges;
    this.showEdges(this.edgesWanted);
  }

  showEdges(wanted) {
    this.edgesWanted = wanted;
    this.lines.visible = wanted || this.kind === 'lattice';
  }

  setColouring(name, stretchMax) {
    this.colouring = name;
    const { coloring, stretchMax: most } = this.material.userData.uniforms;
    coloring.value = colourings.indexOf(name);
    most.value = stretchMax;
    // Colours that mean something are shown as they are.
    this.material.sheenColor.copy(name === 'plain' ? this.material.userData.sheenColor : black);
  }

  moveTo(place) {
    this.surface.moveTo(place, this.colouring === 'stretch');
  }
}

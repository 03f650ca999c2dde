// Draws what acts on the bodies: pins as small balls, forces as arrows with their size beside them.
import {
  ConeGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial,
  SphereGeometry, Vector3,
} from 'three';
import { digits } from './numbers.js';

const units = { gravity: 'm/s²', wind: 'm/s', point: 'N' };
const colours = { gravity: 0x6b6258, wind: 0x2f7fb5, point: 0xd2641e };

/** The value of a keyed quantity: linear between keys, constant outside. */
export function keyed(keys, time) {
  if (time <= keys[0].time) return keys[0].value;
  for (let k = 1; k < keys.length; ++k) {
    if (time >= keys[k].time) continue;
    const s = (time - keys[k - 1].time) / (keys[k].time - keys[k - 1].time);
    return keys[k].value.map((x, i) => (1 - s) * keys[k - 1].value[i] + s * x);
  }
  return keys[keys.length - 1].value;
}

const active = (thing, time) =>
  time >= (thing.from ?? -Infinity) - 1e-9 && time < (thing.until ?? Infinity) - 1e-9;

const magnitude = (v) => Math.hypot(...v);

/** The mean distance of points from their nearest neighbours; infinite for one point. */
function spacing(positions) {
  let sum = 0;
  for (let a = 0; a < positions.length; a += 3) {
    let nearest = Infinity;
    for (let b = 0; b < positions.length; b += 3) {
      if (a === b) continue;
      nearest = Math.min(nearest, Math.hypot(positions[a] - positions[b], positions[a + 1] - positions[b + 1],
        positions[a + 2] - positions[b + 2]));
    }
    sum += nearest;
  }
  return (3 * sum) / positions.length;
}

class Pin {
  constructor(run, description, largestRadius) {
    this.description = description;
    this.track = run.tracks[description.track];
    this.positions = this.track.read({ frame: 0, blend: 0 }, new Float32Array(3 * this.track.count));
    // Balls of a row stand apart, but can still be seen where vertices are very close.
    const radius = Math.min(largestRadius, Math.max(0.3 * spacing(this.positions), 0.2 * largestRadius));
    this.object = new InstancedMesh(new SphereGeometry(radius, 16, 10),
      new MeshStandardMaterial({ color: 0xe0a82e, roughness: 0.35, metalness: 0.2 }), this.track.count);
    this.object.frustumCulled = false;
  }

  moveTo(place, time, wanted) {
    this.object.visible = wanted && active(this.description, time);
    this.track.read(place, this.positions);
    const matrix = new Matrix4();
    for (let p = 0; p < this.track.count; ++p) {
      this.object.setMatrixAt(p, matrix.makeTranslation(...this.positions.subarray(3 * p, 3 * p + 3)));
    }
    this.object.instanceMatrix.needsUpdate = true;
  }
}

/** An arrow of length 1 along y, to be scaled. */
function arrow(colour) {
  const material = new MeshBasicMaterial({ color: colour });
  const shaft = new Mesh(new CylinderGeometry(0.018, 0.018, 0.8, 12).translate(0, 0.4, 0), material);
  const head = new Mesh(new ConeGeometry(0.06, 0.22, 20).translate(0, 0.89, 0), material);
  const object = new Group();
  object.add(shaft, head);
  return object;
}

class Force {
  constructor(run, description, bounds, largest, labels) {
    this.description = description;
    // A force on a rigid body acts on the whole of it.
    const whole = description.type === 'point' ? run.head.bodies[description.body]?.surfaces.skin.track : undefined;
    this.track = run.tracks[description.track ?? whole];
    this.vertices = description.track === undefined ? 1 : this.track.count;
    this.positions = this.track && new Float32Array(3 * this.track.count);
    this.bounds = bounds;
    this.largest = largest;
    this.object = new Group();
    // Wind blows everywhere: a few arrows say so.
    this.arrows = Array.from({ length: description.type === 'wind' ? 3 : 1 }, () => arrow(colours[description.type]));
    this.object.add(...this.arrows);
    this.label = document.createElement('span');
    this.label.className = `label ${description.type}`;
    labels.append(this.label);
  }

  /** Where the arrows begin, for a force along the unit vector `along`. */
  origins(along, length) {
    const { centre, diagonal, half } = this.bounds;
    if (this.track) {
      const middle = [0, 1, 2].map((axis) => {
        let sum = 0;
        for (let p = 0; p < this.track.count; ++p) sum += this.positions[3 * p + axis];
        return sum / this.track.count;
      });
      return [new Vector3(...middle)];
    }
    if (this.description.type === 'gravity') {
      // Beside the bodies at their height, where no wind comes from.
      return [centre.clone().add(new Vector3(this.bounds.lee * (half.x + 0.06 * diagonal), 0.5 * length, 0))];
    }
    const across = Math.abs(along.y) > 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    const reach = Math.abs(along.x) * half.x + Math.abs(along.y) * half.y + Math.abs(along.z) * half.z;
    const begin = centre.clone().addScaledVector(along, -reach - length - 0.03 * diagonal);
    return [-1, 0, 1].map((i) => begin.clone().addScaledVector(across, 0.09 * i * diagonal));
  }

  moveTo(place, time, wanted) {
    const value = keyed(this.description.keys, time);
    const size = magnitude(value);
    this.shown = wanted && size > 0 && active(this.description, time);
    this.object.visible = this.shown;
    this.label.hidden = !this.shown;
    if (!this.shown) return;
    this.track?.read(place, this.positions);
    const along = new Vector3(...value).divideScalar(size);
    const length = 0.16 * this.bounds.diagonal * Math.max(size / this.largest, 0.25);
    const origins = this.origins(along, length);
    this.arrows.forEach((each, i) => {
      each.position.copy(origins[i]);
      each.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along);
      each.scale.set(0.16 * this.bounds.diagonal, length, 0.16 * this.bounds.diagonal);
    });
    this.ends = origins.flatMap((origin) => [origin, origin.clone().addScaledVector(along, length)]);
    const { name, type } = this.description;
    this.anchor = origins[origins.length >> 1].clone().addScaledVector(along, type === 'wind' ? 0 : length);
    const many = this.vertices > 1 ? ' each' : '';
    const called = name === `${type}${name.slice(type.length)}` && /^\d+$/.test(name.slice(type.length)) ? type : name;
    this.label.textContent = `${called} ${digits(size)}\u00a0${units[type] ?? ''}${many}`;
  }
}

export class Annotations {
  constructor(run, bounds, labels) {
    this.object = new Group();
    const centre = new Vector3(...bounds.low.map((x, i) => x + bounds.size[i] / 2));
    const half = new Vector3(...bounds.size).multiplyScalar(0.5);
    const diagonal = Math.max(2 * half.length(), 1e-6);
    this.pins = run.head.pins.map((pin) => new Pin(run, pin, 0.0075 * diagonal));
    const known = run.head.forces.filter((force) => units[force.type]);
    const largest = {};
    for (const force of known) {
      const most = Math.max(...force.keys.map((key) => magnitude(key.value)));
      largest[force.type] = Math.max(largest[force.type] ?? 0, most);
    }
    const lee = known.some((force) => force.type === 'wind' && force.keys[0].value[0] > 0) ? 1 : -1;
    const place = { centre, half, diagonal, lee };
    this.forces = known.map((force) => new Force(run, force, place, largest[force.type], labels));
    for (const each of [...this.pins, ...this.forces]) this.object.add(each.object);
    this.pinsWanted = true;
    this.forcesWanted = true;
  }

  /** Where the arrows of the first frame begin and end: x, y, z of each. */
  reach() {
    this.moveTo({ frame: 0, blend: 0 }, 0);
    return this.forces.filter((force) => force.shown).flatMap((force) => force.ends.flatMap((end) => end.toArray()));
  }

  moveTo(place, time) {
    for (const pin of this.pins) pin.moveTo(place, time, this.pinsWanted);
    for (const force of this.forces) force.moveTo(place, time, this.forcesWanted);
  }

  /** Puts the labels beside their arrows. */
  placeLabels(stage) {
    const { clientWidth: width, clientHeight: height } = stage.canvas;
    for (const force of this.forces) {
      if (!force.shown) continue;
      const at = force.anchor.clone().applyMatrix4(stage.world.matrixWorld).project(stage.camera);
      const x = ((at.x + 1) / 2) * width;
      const long = force.label.offsetWidth;
      const beside = at.x < 0 ? x - long - 12 : x + 12; // away from the bodies
      const inside = Math.min(Math.max(beside, 4), width - long - 4);
      force.label.style.transform = `translate(${inside}px, ${((1 - at.y) / 2) * height}px) translateY(-50%)`;
      force.label.style.visibility = at.z < 1 ? 'visible' : 'hidden';
    }
  }
}

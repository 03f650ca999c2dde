// The place where the run is shown: renderer, lights, ground, camera.
import {
  Box3, Color, DirectionalLight, Group, HemisphereLight, Mesh, PCFShadowMap,
  PerspectiveCamera, PlaneGeometry, Scene, ShaderMaterial, ShadowMaterial, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { roundUp } from './numbers.js';

export const presets = {
  'three-quarter': [30, 15], front: [0, 0], side: [90, 0], back: [180, 0], top: [0, 89.9],
};

const gridShader = {
  vertex: `
    varying vec2 place;
    void main() {
      place = position.xy;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`,
  fragment: `
    uniform vec3 ink;
    uniform float cell, reach;
    varying vec2 place;
    float lines(float period) {
      vec2 at = place / period;
      vec2 near = abs(fract(at - 0.5) - 0.5) / fwidth(at);
      return 1.0 - min(min(near.x, near.y), 1.0);
    }
    void main() {
      float fade = 1.0 - smoothstep(0.25, 1.0, length(place) / reach);
      float strength = max(0.10 * lines(cell), 0.22 * lines(5.0 * cell));
      gl_FragColor = vec4(ink, strength * fade);
    }`,
};

export class Stage {
  /** @param places x, y, z of points that the run reaches, in its own coordinates: what the camera must see */
  constructor(canvas, places) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: false });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.world = new Group(); // turned so that up is up
    this.scene.add(this.world);
    this.camera = new PerspectiveCamera(32, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.autoRotateSpeed = 1.5;
    this.controls.addEventListener('change', () => this.invalidate());
    canvas.addEventListener('webglcontextrestored', () => this.invalidate());
    this.controls.addEventListener('start', () => {
      this.preset = null; // the eye is where the viewer put it
    });
    this.places = places;
    this.beside = []; // more that the camera must see
    this.dirty = true;
    this.insets = { left: 0, right: 0, top: 0, bottom: 0 };
    this.preset = 'three-quarter';
    this.addLights();
    this.addGround();
  }

  invalidate() {
    this.dirty = true;
  }

  addLights() {
    this.sky = new HemisphereLight(0xffffff, 0x8d8172, 1);
    this.key = new DirectionalLight(0xfff4e2, 1);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.radius = 4;
    this.fill = new DirectionalLight(0xdfe9ff, 0.5);
    this.scene.add(this.sky, this.key, this.key.target, this.fill, this.fill.target);
  }

  addGround() {
    const plane = new PlaneGeometry(1, 1);
    this.shadow = new Mesh(plane, new ShadowMaterial({ opacity: 0.22, depthWrite: false }));
    this.shadow.receiveShadow = true;
    this.shadow.renderOrder = -2;
    this.grid = new Mesh(plane, new ShaderMaterial({
      uniforms: { ink: { value: new Color(0x000000) }, cell: { value: 1 }, reach: { value: 1 } },
      vertexShader: gridShader.vertex, fragmentShader: gridShader.fragment,
      transparent: true, depthWrite: false,
    }));
    this.grid.renderOrder = -1;
    this.ground = new Group();
    this.ground.add(this.shadow, this.grid);
    this.ground.rotation.x = -Math.PI / 2;
    this.scene.add(this.ground);
  }

  /** Turns the run so that its axis `up` ('y' or 'z') points up, and fits everything to it. */
  setUp(up) {
    this.up = up;
    this.world.rotation.x = up === 'z' ? -Math.PI / 2 : 0;
    this.world.updateMatrixWorld(true);
    this.box = new Box3().setFromArray(this.places).applyMatrix4(this.world.matrixWorld);
    this.centre = this.box.getCenter(new Vector3());
    this.size = Math.max(this.box.getSize(new Vector3()).length(), 1e-6);
    const floor = this.box.min.y - 0.02 * this.size;
    this.ground.position.set(this.centre.x, floor, this.centre.z);
    const reach = 2.2 * this.size;
    this.gridCell = roundUp(this.size / 24);
    // Lines stand at multiples of the cell in the run's coordinates.
    this.ground.position.x = Math.round(this.centre.x / this.gridCell) * this.gridCell;
    this.ground.position.z = Math.round(this.centre.z / this.gridCell) * this.gridCell;
    const area = new PlaneGeometry(2 * reach, 2 * reach);
    this.shadow.geometry = area;
    this.grid.geometry = area;
    this.grid.material.uniforms.cell.value = this.gridCell;
    this.grid.material.uniforms.reach.value = reach;
    const shadow = this.key.shadow;
    const half = 0.75 * this.size;
    Object.assign(shadow.camera, { left: -half, right: half, top: half, bottom: -half, near: 0, far: 6 * this.size });
    shadow.camera.updateProjectionMatrix();
    shadow.normalBias = 0.009 * this.size;
    shadow.bias = -0.0006;
    this.setView(this.preset ?? 'three-quarter');
  }

  setTheme(dark) {
    this.grid.material.uniforms.ink.value.set(dark ? 0xffffff : 0x3a3128);
    this.shadow.material.opacity = dark ? 0.5 : 0.22;
    this.sky.intensity = dark ? 0.85 : 1.15;
    this.key.intensity = dark ? 2.1 : 2.5;
    this.invalidate();
  }

  setGround(visible) {
    this.ground.visible = visible;
    this.invalidate();
  }

  /** Stands where everything that ever happens is seen, in the part of the window that panels leave free. */
  setView(name) {
    this.preset = name;
    const [azimuth, elevation] = presets[name].map((degrees) => (degrees * Math.PI) / 180);
    const back = new Vector3(Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation),
      Math.cos(azimuth) * Math.cos(elevation));
    const across = new Vector3(Math.cos(azimuth), 0, -Math.sin(azimuth));
    const up = new Vector3().crossVectors(back, across);
    const { width, height } = this.window;
    const free = { x: width - this.insets.left - this.insets.right, y: height - this.insets.top - this.insets.bottom };
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360) * 0.92;
    const slope = { x: (tangent * free.x) / height, y: (tangent * free.y) / height };
    // A point at x across and z towards the eye is seen if |x - eye| <= slope (distance - z): the largest
    // values of x + slope z and of -x + slope z decide distance and place of the eye.
    let [left, right, low, high] = [-Infinity, -Infinity, -Infinity, -Infinity];
    const p = new Vector3();
    const seen = [...this.places, ...this.beside];
    for (let i = 0; i < seen.length; i += 3) {
      p.fromArray(seen, i).applyMatrix4(this.world.matrixWorld).sub(this.centre);
      const [x, y, z] = [p.dot(across), p.dot(up), p.dot(back)];
      right = Math.max(right, x + slope.x * z);
      left = Math.max(left, -x + slope.x * z);
      high = Math.max(high, y + slope.y * z);
      low = Math.max(low, -y + slope.y * z);
    }
    const distance = Math.max((left + right) / (2 * slope.x), (low + high) / (2 * slope.y), 0.1 * this.size);
    const target = this.centre.clone().addScaledVector(across, (right - left) / 2).addScaledVector(up, (high - low) / 2);
    this.camera.near = distance / 200;
    this.camera.far = distance * 30;
    this.camera.position.copy(target).addScaledVector(back, distance);
    this.controls.target.copy(target);
    this.controls.minDistance = distance / 40;
    this.controls.maxDistance = distance * 8;
    this.applyInsets();
    this.controls.update();
    this.invalidate();
  }

  get window() {
    return { width: this.canvas.clientWidth || 1, height: this.canvas.clientHeight || 1 };
  }

  /** Tells which margins of the window panels cover. A view that was chosen is fitted anew. */
  setInsets(insets) {
    this.insets = insets;
    this.resize();
    if (this.preset) this.setView(this.preset);
    this.applyInsets();
  }

  /** Shifts the picture so that the centre of the free part of the window is the centre of the view. */
  applyInsets() {
    const { width, height } = this.window;
    const { left, right, top, bottom } = this.insets;
    this.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
    this.camera.updateProjectionMatrix();
  }

  resize() {
    const { width, height } = this.window;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const size = this.renderer.getSize(new Vector2());
    if (size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio) return;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.applyInsets();
    this.invalidate();
  }

  /** Draws if something changed; says so. */
  draw() {
    this.controls.update();
    if (!this.dirty) return false;
    this.dirty = false;
    // The lights go with the eye, as in muslin's pictures: a key behind the left shoulder.
    const back = this.camera.position.clone().sub(this.controls.target);
    back.y = 0;
    if (back.lengthSq() < 1e-12 * this.size * this.size) back.set(0, 0, 1);
    back.normalize();
    const right = new Vector3(back.z, 0, -back.x);
    this.key.position.copy(this.centre).addScaledVector(back, 1.1 * this.size).addScaledVector(right, -1.6 * this.size);
    this.key.position.y += 2.2 * this.size;
    this.key.target.position.copy(this.centre);
    this.fill.position.copy(this.centre).addScaledVector(back, this.size).addScaledVector(right, 2 * this.size);
    this.fill.target.position.copy(this.centre);
    this.renderer.render(this.scene, this.camera);
    return true;
  }
}

// How a body takes the light, and the colours it can have.
import { Color, DataTexture, DoubleSide, LinearFilter, MeshPhysicalMaterial, SRGBColorSpace } from 'three';
import { mapColour } from './colours.js';

export const colourings = ['plain', 'stretch', 'checker', 'uv'];

let map;
function mapTexture() {
  if (map) return map;
  const texels = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) texels.set([...mapColour(i / 255), 255], 4 * i);
  map = new DataTexture(texels, 256, 1);
  map.colorSpace = SRGBColorSpace;
  map.minFilter = map.magFilter = LinearFilter;
  map.needsUpdate = true;
  return map;
}

/**
 * @param body {colour, back_colour, solid} as the page describes it
 * @param checks {size, extent} of the checker and of the pattern coordinates [m]
 */
export function clothMaterial(body, checks) {
  const material = new MeshPhysicalMaterial({
    side: DoubleSide,
    shadowSide: DoubleSide,
    color: new Color().setRGB(...body.colour, SRGBColorSpace),
    roughness: body.solid ? 0.5 : 0.9,
    sheen: body.solid ? 0 : 0.5,
    sheenRoughness: 0.6,
    sheenColor: new Color().setRGB(...body.colour.map((x) => 0.5 + 0.5 * x), SRGBColorSpace),
    specularIntensity: body.solid ? 0.7 : 0.25,
    polygonOffset: true, // lets the edges lie on top
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  const uniforms = {
    coloring: { value: 0 },
    backColour: { value: new Color().setRGB(...body.back_colour, SRGBColorSpace) },
    stretchMap: { value: mapTexture() },
    stretchMax: { value: 1 },
    checkSize: { value: checks.size },
    patternLow: { value: checks.low },
    patternSize: { value: checks.extent },
  };
  material.userData.uniforms = uniforms;
  material.userData.sheenColor = material.sheenColor.clone();
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>
        attribute vec2 pattern;
        attribute float stretch;
        varying vec2 patternAt;
        varying float stretchAt;`)
      .replace('#include <begin_vertex>', `#include <begin_vertex>
        patternAt = pattern;
        stretchAt = stretch;`);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `#include <common>
        uniform int coloring;
        uniform vec3 backColour;
        uniform sampler2D stretchMap;
        uniform float stretchMax, checkSize;
        uniform vec2 patternLow, patternSize;
        varying vec2 patternAt;
        varying float stretchAt;
        float checks(vec2 at) {
          vec2 width = max(fwidth(at), 1e-6);
          vec2 wave = abs(fract(at * 0.5) - 0.5) * 2.0 - 0.5;
          vec2 side = clamp(wave / width + 0.5, 0.0, 1.0);
          float sharp = side.x + side.y - 2.0 * side.x * side.y;
          return mix(sharp, 0.5, clamp(max(width.x, width.y) - 0.6, 0.0, 1.0));
        }`)
      .replace('#include <color_fragment>', `#include <color_fragment>
        if (!gl_FrontFacing) diffuseColor.rgb = backColour;
        if (coloring == 1) {
          diffuseColor.rgb = texture2D(stretchMap, vec2(clamp(stretchAt / stretchMax, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb;
        } else if (coloring == 2) {
          diffuseColor.rgb = mix(mix(diffuseColor.rgb, vec3(0.93), 0.82), diffuseColor.rgb * 0.8, checks(patternAt / checkSize));
        } else if (coloring == 3) {
          vec2 share = (patternAt - patternLow) / patternSize;
          vec3 hue = mix(mix(vec3(0.10, 0.13, 0.30), vec3(0.85, 0.24, 0.14), share.x), mix(vec3(0.10, 0.52, 0.52), vec3(0.97, 0.83, 0.42), share.x), share.y);
          diffuseColor.rgb = mix(hue, hue * 0.72, checks(patternAt / checkSize));
        }`);
  };
  return material;
}

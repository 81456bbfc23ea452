// Hatching of a plate where postures are outside joint limits: what is evaluated there cannot be machined.

import * as THREE from "three";

const SHADER = {
  vertexShader: `
    attribute float outside;
    varying float is_outside;
    varying vec2 at_mm;
    void main() {
      is_outside = outside;
      at_mm = position.xy;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`,
  fragmentShader: `
    uniform float pitch_mm;
    varying float is_outside;
    varying vec2 at_mm;
    void main() {
      if (is_outside < 0.5) discard;
      float across = (at_mm.x + at_mm.y) / pitch_mm;
      float blur = max(fwidth(across), 1e-4);
      // Distance from the middle of the nearest stripe, 0 to 0.5.
      float off = abs(fract(across) - 0.5);
      // A pattern finer than the pixels is an even grey.
      float stripe = mix(1.0 - smoothstep(0.16 - blur, 0.16 + blur, off), 0.32, smoothstep(0.4, 1.0, blur));
      gl_FragColor = vec4(mix(vec3(0.62), vec3(0.03, 0.04, 0.05), stripe), mix(0.42, 0.9, stripe));
    }`,
};

export class Hatch {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  private readonly pitch = { value: 30 };

  constructor() {
    const material = new THREE.ShaderMaterial({ ...SHADER, uniforms: { pitch_mm: this.pitch }, transparent: true, depthWrite: false, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.visible = false;
  }

  /** On the points of this geometry, those of the list; `size_mm`: its diagonal. */
  draw(geometry: THREE.BufferGeometry, outside: number[], size_mm: number): void {
    this.mesh.visible = outside.length > 0;
    if (outside.length === 0) return;
    const count = geometry.getAttribute("position").count;
    let flags = geometry.getAttribute("outside") as THREE.BufferAttribute | undefined;
    if (!flags || flags.count !== count) geometry.setAttribute("outside", (flags = new THREE.BufferAttribute(new Float32Array(count), 1)));
    (flags.array as Float32Array).fill(0);
    for (const index of outside) flags.array[index] = 1;
    flags.needsUpdate = true;
    this.mesh.geometry = geometry;
    this.pitch.value = Math.max(4, size_mm / 32);
  }
}

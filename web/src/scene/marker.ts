// The point of the path to which the robot is sent: there at once, before the robot is.

import * as THREE from "three";
import type { Vec3 } from "../types";

const SIZE_PX = 12;

export class Marker {
  readonly group = new THREE.Group();
  private readonly place = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(new Float32Array(3), 3));

  constructor() {
    const dot = new THREE.Points(this.place, new THREE.PointsMaterial({ size: SIZE_PX, sizeAttenuation: false, map: ring(), transparent: true, depthTest: false, alphaTest: 0.05 }));
    dot.frustumCulled = false;
    dot.renderOrder = 11;
    this.group.add(dot);
    this.group.visible = false;
  }

  draw(at: Vec3 | null): void {
    this.group.visible = at !== null;
    if (at === null) return;
    this.place.getAttribute("position").setXYZ(0, ...at).needsUpdate = true;
  }
}

/** A white disc with a dark edge: seen on every colour, light and dark. */
function ring(): THREE.Texture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d")!;
  context.beginPath();
  context.arc(32, 32, 24, 0, 2 * Math.PI);
  context.fillStyle = "#ffffff";
  context.fill();
  context.lineWidth = 12;
  context.strokeStyle = "#14181d";
  context.stroke();
  return new THREE.CanvasTexture(canvas);
}

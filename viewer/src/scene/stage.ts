/** Renderer, lights, sky and fog: everything except the bodies and overlays. */
import {
  DirectionalLight,
  Fog,
  HemisphereLight,
  type Object3D,
  PCFShadowMap,
  type PerspectiveCamera,
  Scene,
  SRGBColorSpace,
  NeutralToneMapping,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Saving } from "./quality";
import { horizon, makeSky } from "./sky";

const sunDirection = new Vector3(0.55, 1, 0.38).normalize();

/** pixels drawn per CSS pixel in each direction, without a graphics card */
const softwareRatio = 1.4;

export class Stage {
  readonly scene = new Scene();
  private readonly renderer: WebGLRenderer;
  private readonly sun = new DirectionalLight(0xffefd6, 2.55);
  private width = 1;
  private height = 1;
  private drawnShare = 0;
  private readonly fog = new Fog(horizon, 60, 400);

  /** Throws when the browser has no WebGL 2. `isSoftware`: uses cheaper settings. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly isSoftware: boolean,
  ) {
    // several samples per pixel are slow without a graphics card: still pictures have more pixels instead
    this.renderer = new WebGLRenderer({ canvas, antialias: !isSoftware, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.toneMappingExposure = 1.0;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    this.scene.fog = this.fog;
    this.scene.add(makeSky(), new HemisphereLight(0xdbe8fa, 0xa39888, 1.95));
    const back = new DirectionalLight(0xa9c4ff, 0.45);
    back.position.set(-0.7, 0.45, -0.6);
    this.scene.add(back);

    this.sun.castShadow = true;
    const side = isSoftware ? 2048 : this.renderer.capabilities.maxTextureSize >= 8192 ? 4096 : 2048;
    this.sun.shadow.mapSize.set(side, side);
    this.sun.shadow.radius = 3;
    this.sun.shadow.intensity = 0.85;
    this.scene.add(this.sun, this.sun.target);
  }

  add(object: Object3D): void {
    this.scene.add(object);
  }

  resize(width: number, height: number): void {
    this.width = width;
    this.height = height;
    this.drawnShare = 0;
  }

  /** The shadows of the last picture are wrong: something that casts them has changed. */
  invalidateShadows(): void {
    this.renderer.shadowMap.needsUpdate = true;
  }

  /** Draws one picture; shadows are sharp within `radius` of `focus`. */
  render(
    camera: PerspectiveCamera,
    { share, shadows }: Saving,
    focus: Vector3,
    radius: number,
    distance: number,
  ): void {
    if (share !== this.drawnShare) {
      this.renderer.setPixelRatio(share * (this.isSoftware ? softwareRatio : Math.min(window.devicePixelRatio, 2)));
      this.renderer.setSize(this.width, this.height, false);
      this.drawnShare = share;
    }
    this.sun.castShadow = shadows;
    if (shadows) this.aimSun(focus, radius);
    this.fog.near = distance + 2 * radius;
    this.fog.far = 4 * distance + 16 * radius;
    this.renderer.render(this.scene, camera);
  }

  /** Moves the shadow map in full texels, so that shadow edges stay stable while the camera follows a body. */
  private aimSun(focus: Vector3, radius: number): void {
    const { shadow } = this.sun;
    const { camera } = shadow;
    const wide = 2 ** (Math.ceil(4 * Math.log2(Math.max(radius, 0.5))) / 4);
    if (camera.right !== wide) {
      camera.left = camera.bottom = -wide;
      camera.right = camera.top = wide;
      camera.near = 0;
      camera.far = 8 * wide;
      camera.updateProjectionMatrix();
      const texel = (2 * wide) / shadow.mapSize.x;
      shadow.normalBias = 1.2 * texel;
      shadow.bias = -0.0002;
    }
    const texel = (2 * wide) / shadow.mapSize.x;
    const right = new Vector3(0, 1, 0).cross(sunDirection).normalize();
    const up = sunDirection.clone().cross(right);
    const snap = (axis: Vector3) => Math.round(focus.dot(axis) / texel) * texel;
    const target = new Vector3()
      .copy(right)
      .multiplyScalar(snap(right))
      .addScaledVector(up, snap(up))
      .addScaledVector(sunDirection, focus.dot(sunDirection));
    const position = target.clone().addScaledVector(sunDirection, 4 * wide);
    if (!position.equals(this.sun.position)) this.invalidateShadows();
    this.sun.target.position.copy(target);
    this.sun.position.copy(position);
  }
}

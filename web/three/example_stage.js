import { AmbientLight, Box3, BoxGeometry, DirectionalLight, Mesh, MeshStandardMaterial, PerspectiveCamera, Scene, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/**
 * A scene around an object of the examples: light, a floor that it stands on, a camera to turn.
 * @param {import("three").Object3D} object
 * @param {import("three").WebGLRenderer|import("three/webgpu").WebGPURenderer} renderer
 */
export function stage(object, renderer) {
  const scene = new Scene();
  const box = new Box3().setFromObject(object);
  const [middle, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
  const floor = new Mesh(new BoxGeometry(2 * size.x, 0.02 * size.y, 2 * size.z), new MeshStandardMaterial({ color: 0x8899aa }));
  floor.position.set(middle.x, middle.y - 0.35 * size.y, middle.z);
  const sun = new DirectionalLight(0xffffff, 2.5);
  sun.position.set(-1, 3, 2);
  scene.add(object, floor, new AmbientLight(0xffffff, 1), sun);
  const camera = new PerspectiveCamera(32, innerWidth / innerHeight, size.length() / 100, 100 * size.length());
  camera.position.copy(middle).add(new Vector3(0.5, 0.4, 0.8).setLength(1.9 * size.length()));
  renderer.setSize(innerWidth, innerHeight);
  document.body.appendChild(renderer.domElement);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.copy(middle);
  controls.update();
  const draw = () => renderer.render(scene, camera);
  controls.addEventListener("change", draw);
  draw();
  return { scene, camera, renderer, object };
}

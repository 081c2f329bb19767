import { Camera } from "./camera.js";

/** Degrees for each pixel that a pointer moves, and for each press of an arrow. */
const TURN = Object.freeze({ pixel: 0.4, press: 10 });
const ZOOM = Object.freeze({ least: 0.5, most: 20, wheel: 0.0015, press: 1.2 });

/**
 * Turns a camera by mouse, touch and keyboard.
 * @param {HTMLElement} element
 * @param {import("./camera.js").Camera} camera
 * @param {() => void} changed
 */
export function orbit(element, camera, changed) {
  /** @type {Map<number, {x: number, y: number}>} */
  const pointers = new Map();
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, (event) => pointers.delete(/** @type {PointerEvent} */ (event).pointerId));
  }
  element.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const spread = spreadOf(pointers);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (pointers.size === 2) zoom(camera, spreadOf(pointers) / spread);
    else if (pointers.size > 2 || event.shiftKey || event.buttons === 2) shine(camera, event.clientX - before.x, before.y - event.clientY);
    else turn(camera, TURN.pixel * (before.x - event.clientX), TURN.pixel * (event.clientY - before.y));
    changed();
  });
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoom(camera, Math.exp(-ZOOM.wheel * event.deltaY));
      changed();
    },
    { passive: false },
  );
}

/**
 * Whether a key moved the camera.
 * @param {import("./camera.js").Camera} camera
 * @param {string} key
 */
export function moveByKey(camera, key) {
  /** @type {Object<string, () => void>} */
  const moves = {
    ArrowLeft: () => turn(camera, -TURN.press, 0),
    ArrowRight: () => turn(camera, TURN.press, 0),
    ArrowUp: () => turn(camera, 0, TURN.press),
    ArrowDown: () => turn(camera, 0, -TURN.press),
    "+": () => zoom(camera, ZOOM.press),
    "-": () => zoom(camera, 1 / ZOOM.press),
    0: () => Object.assign(camera, new Camera()),
  };
  moves[key]?.();
  return key in moves;
}

/** @param {Map<number, {x: number, y: number}>} pointers */
function spreadOf(pointers) {
  const [a, b] = [...pointers.values()];
  return b ? Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1) : 1;
}

/** @param {import("./camera.js").Camera} camera @param {number} across @param {number} up degrees */
function turn(camera, across, up) {
  camera.azimuth = (camera.azimuth + across) % 360;
  camera.elevation = Math.min(Math.max(camera.elevation + up, -90), 90);
}

/** Moves the lamp. @param {import("./camera.js").Camera} camera @param {number} across @param {number} up pixels */
function shine(camera, across, up) {
  camera.lampAzimuth = (camera.lampAzimuth + TURN.pixel * across) % 360;
  camera.lampElevation = Math.min(Math.max(camera.lampElevation + TURN.pixel * up, -90), 90);
}

/** @param {import("./camera.js").Camera} camera @param {number} factor */
function zoom(camera, factor) {
  camera.zoom = Math.min(Math.max(camera.zoom * factor, ZOOM.least), ZOOM.most);
}

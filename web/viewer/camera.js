/** Room between the unit ball and the picture's edge. */
const ROOM = 1.02;

/** A pinhole camera around the unit ball; angles in degrees. */
export class Camera {
  constructor() {
    this.azimuth = 30;
    this.elevation = 20;
    this.fov = 32;
    this.zoom = 1;
    this.lampAzimuth = -26.565;
    this.lampElevation = 28.22;
  }

  /** Right, up and backward, as columns of a matrix (9). */
  axes() {
    const backward = towards(this.azimuth, this.elevation);
    const a = (this.azimuth * Math.PI) / 180;
    const right = [Math.cos(a), 0, -Math.sin(a)];
    return [...right, ...cross(backward, right), ...backward];
  }

  eye() {
    const distance = ROOM / Math.sin((this.fov * Math.PI) / 360);
    return this.axes().slice(6).map((value) => value * distance);
  }

  /** Half the picture at distance 1: across and down. @param {number} width @param {number} height */
  halfSize(width, height) {
    const half = Math.tan((this.fov * Math.PI) / 360) / this.zoom;
    const least = Math.min(width, height);
    return [(half * width) / least, (half * height) / least];
  }

  /** Where the lamp is, which goes with the camera: left, up and behind it to begin with. */
  lamp() {
    const axes = this.axes();
    const [x, y, z] = towards(this.lampAzimuth, this.lampElevation);
    return [0, 1, 2].map((i) => x * axes[i] + y * axes[3 + i] + z * axes[6 + i]);
  }

  /**
   * From the normalized frame to clip space, column by column (16).
   * @param {number} width @param {number} height @param {number[]} jitter in clip space
   */
  projection(width, height, jitter) {
    const [across, down] = this.halfSize(width, height);
    const axes = this.axes();
    const eye = this.eye();
    const distance = Math.hypot(...eye);
    const [near, far] = [Math.max(distance - 1.5, 0.01), distance + 1.5];
    const rows = [0, 3, 6].map((at) => [axes[at], axes[at + 1], axes[at + 2]]);
    const shifts = rows.map((row) => -row.reduce((sum, value, i) => sum + value * eye[i], 0));
    const column = (/** @type {(row: number) => number} */ of) => {
      const [x, y, z] = [of(0), of(1), of(2)];
      const depth = ((far + near) * -z) / (far - near);
      return { x, y, z, depth };
    };
    const matrix = [];
    for (let i = 0; i < 4; i++) {
      const { x, y, z, depth } = column((row) => (i < 3 ? rows[row][i] : shifts[row]));
      const offset = i === 3 ? (-2 * far * near) / (far - near) : 0;
      matrix.push(x / across + jitter[0] * z, y / down + jitter[1] * z, depth + offset, -z);
    }
    return matrix;
  }
}

/** A unit vector: z, turned around y and up. @param {number} azimuth @param {number} elevation degrees */
function towards(azimuth, elevation) {
  const [a, e] = [(azimuth * Math.PI) / 180, (elevation * Math.PI) / 180];
  return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
}

/** @param {number[]} a @param {number[]} b */
function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Enumerations of format_spec.md: the numbers count from 1. */
export const NETWORKS = ["sdf", "chart", "uv"];
export const ENCODINGS = ["identity", "fourier"];
export const CONDITIONINGS = ["none", "scalar", "chart_affine"];
export const ACTIVATIONS = ["sine", "relu"];
export const OUTPUTS = ["identity", "tanh", "sigmoid"];
export const ALPHA_MODES = ["opaque", "mask", "blend"];
export const SLOTS = ["base_color", "normal", "metallic_roughness", "occlusion", "emissive"];
export const WRAPS = ["repeat", "clamp", "mirror"];
export const FILTERS = ["linear", "nearest"];
export const MIME_TYPES = ["image/png", "image/jpeg", "image/webp", "image/avif"];
export const ENDINGS = [".png", ".jpg", ".webp", ".avif"];
export const MEASURES = [
  "preset",
  "seed",
  "hidden_share",
  "open_surface_share",
  "distance_error",
  "chart_accuracy",
  "uv_error_median",
  "uv_error_mean",
  "other_form_bytes",
  "made_up_share",
  "lost_share",
];
export const PRESETS = ["balanced", "paper", "fast", "best"];
export const CODINGS = ["dense", "coo", "csc", "csr", "dia", "entropy", "delta_init"];
export const STEPS = ["byte", "float16", "float32", "same", "rows1", "rows2", "rows3"];
export const NUMBERS = ["float32", "float16", "int8", "int16", "int32"];

/** Caps of section 9. */
export const MAX_SECTIONS = 64;
export const MAX_FILE = 2147483647;
export const MAX_UNPACKED = 33554432;
export const MAX_METADATA = 262144;
export const MAX_DEPTH = 8;
export const MAX_ITEMS = 4096;
export const MAX_VALUES = 16384;
export const MAX_TEXT = 1024;
export const MAX_CHARTS = 65535;
export const MAX_HIDDEN_LAYERS = 32;
export const MAX_WIDTH = 1024;
export const MAX_INIT_SEED = 4294967295;
export const MAX_WEIGHTS = 1048576;
export const MAX_SYMBOL = 8388607;
export const MAX_CELLS = 256;

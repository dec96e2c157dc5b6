// Controls of a spectrum, wherever one stands in the look: objects, lamps, ambient light.

/** Of all types, as far as the server does not tell which there may be. */
const kTypes = [
  "display",
  "total_radiance",
  "rgb",
  "channels",
  "materials",
  "black_body",
  "tabulated",
  "lines",
  "constant",
  "equal_energy",
  "power_law",
  "gaussian",
  "dominant_wavelength",
  "sum",
  "lit",
];

/** What a type begins with. */
const kBegin = {
  black_body: {temperature_K: 5800},
  tabulated: {file: ""},
  lines: {
    lines: [
      [589.0, 1],
      [589.6, 0.5],
    ],
  },
  constant: {radiance: 1},
  equal_energy: {radiance: 1},
  power_law: {index: -2, radiance: 1, at_nm: 550},
  gaussian: {centre_nm: 550, fwhm_nm: 40, radiance: 1},
  dominant_wavelength: {wavelength_nm: 550, purity: 1, radiance: 1},
  sum: {of: [{type: "equal_energy"}, {type: "lines", lines: [[589.3, 10]]}]},
  lit: {
    light: {type: "black_body", temperature_K: 5800},
    reflectance: {type: "gaussian", centre_nm: 600, fwhm_nm: 100},
  },
  channels: {
    spectra: [
      {type: "gaussian", centre_nm: 610, fwhm_nm: 40},
      {type: "gaussian", centre_nm: 540, fwhm_nm: 40},
      {type: "gaussian", centre_nm: 460, fwhm_nm: 40},
    ],
  },
  materials: {
    spectra: [
      {type: "black_body", temperature_K: 3000},
      {type: "black_body", temperature_K: 10000},
    ],
  },
};

const radiance = {label: "Radiance", unit: "W m⁻² sr⁻¹ nm⁻¹", scale: "log", min: 1e-3, max: 1e3, least: 0, most: 1e20};
const wavelength = {unit: "nm", min: 300, max: 1200, least: 1e-6, most: 1e15};

/** @type {Object<string, import("./form.js").Field[]>} entries of each type */
const kFields = {
  black_body: [
    {
      key: "temperature_K",
      kind: "number",
      label: "Temperature",
      unit: "K",
      scale: "log",
      min: 500,
      max: 50000,
      least: 1,
      most: 1e9,
      digits: 5,
      fallback: 5800,
    },
  ],
  tabulated: [
    {key: "file", kind: "text", label: "Table", fallback: ""},
    {key: "beyond", kind: "select", label: "Beyond it", options: ["zero", "hold"], fallback: "zero"},
  ],
  lines: [{key: "lines", kind: "json", label: "Lines", title: "[wavelength in nm, strength in W m⁻² sr⁻¹], ..."}],
  constant: [
    {key: "radiance", kind: "number", ...radiance, fallback: 1},
    {key: "from_nm", kind: "number", label: "From", ...wavelength, optional: true, slider: false},
    {key: "to_nm", kind: "number", label: "To", ...wavelength, optional: true, slider: false},
  ],
  equal_energy: [{key: "radiance", kind: "number", ...radiance, fallback: 1}],
  power_law: [
    {key: "index", kind: "number", label: "Index", min: -20, max: 20, step: 0.1, least: -20, most: 20},
    {key: "at_nm", kind: "number", label: "At", ...wavelength, fallback: 550},
    {key: "radiance", kind: "number", ...radiance, fallback: 1},
  ],
  gaussian: [
    {key: "centre_nm", kind: "number", label: "Centre", ...wavelength},
    {
      key: "fwhm_nm",
      kind: "number",
      label: "Width",
      unit: "nm",
      scale: "log",
      min: 0.1,
      max: 1000,
      least: 1e-3,
      most: 1e9,
    },
    {key: "radiance", kind: "number", ...radiance, fallback: 1},
  ],
  dominant_wavelength: [
    {key: "wavelength_nm", kind: "number", label: "Wavelength", unit: "nm", min: 360, max: 830, least: 360, most: 830},
    {key: "purity", kind: "number", label: "Purity", min: 0, max: 1, step: 0.01, least: 0, most: 1, fallback: 1},
    {key: "radiance", kind: "number", ...radiance, fallback: 1},
  ],
  sum: [{key: "of", kind: "json", label: "Sum of"}],
  lit: [
    {key: "light", kind: "json", label: "Light"},
    {key: "reflectance", kind: "json", label: "Reflectance"},
  ],
  channels: [{key: "spectra", kind: "json", label: "Spectra", title: "of red, green and blue"}],
  materials: [{key: "spectra", kind: "json", label: "Spectra", title: "of the materials, by number"}],
};
const kWithoutUnit = ["display", "total_radiance", "rgb", "channels", "materials"];

const luminance = {
  kind: "number",
  label: "Luminance",
  unit: "cd/m²",
  optional: true,
  slider: false,
  scale: "log",
  min: 1e-3,
  max: 1e10,
  least: 0,
  most: 1e20,
  title: "what the eye sees of it where nothing is shifted; empty: as the spectrum has it",
};

/** Such as `type` begins with. */
export const newSpectrum = (type) => ({type, ...structuredClone(kBegin[type] ?? {})});

/**
 * @param {object} app @param {string} pointer of the spectrum @param {{types?: string[], materials?: boolean}} [options]
 * @returns {import("./form.js").Field[]}
 */
export function spectrumFields(app, pointer, {types = kTypes, materials = false} = {}) {
  const {store} = app;
  const type = store.get(`${pointer}/type`) ?? "display";
  // Tables cannot be sent to the server, and materials go with a texture of theirs.
  const possible = (word) => word === type || (word !== "tabulated" && (word !== "materials" || materials));
  const words = (store.words[`${pointer}/type`] ?? types).filter(possible);
  const choose = {
    kind: "select",
    pointer: `${pointer}/type`,
    label: "Spectrum",
    options: words,
    value: type,
    put: (next) => store.set(pointer, newSpectrum(next)),
    reset: () => store.reset(pointer),
  };
  const entries = (kFields[type] ?? []).map(({key, ...field}) => ({
    pointer: `${pointer}/${key}`,
    begin: kBegin[type]?.[key],
    ...field,
  }));
  const scaled = kWithoutUnit.includes(type) ? [] : [{pointer: `${pointer}/luminance_cd_m2`, ...luminance}];
  return [choose, ...entries, ...scaled];
}

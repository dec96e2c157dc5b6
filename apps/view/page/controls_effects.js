// What relativity does to the light that is seen.

import {formPanel} from "./form.js";

const kPower = {kind: "number", min: -10, max: 10, step: 0.5, least: -10, most: 10};

export function setup(app) {
  formPanel(
    app,
    "effects",
    "Effects",
    () => [
      {kind: "switch", pointer: "/effects/doppler", label: "Doppler effect", fallback: true},
      {kind: "switch", pointer: "/effects/searchlight", label: "Searchlight", fallback: true},
      {kind: "group", label: "Powers of the frequency ratio"},
      {...kPower, pointer: "/effects/radiance_exponents/spectral", label: "Spectral", fallback: 5},
      {...kPower, pointer: "/effects/radiance_exponents/integrated", label: "Integrated", fallback: 4},
    ],
    {open: true},
  );
}

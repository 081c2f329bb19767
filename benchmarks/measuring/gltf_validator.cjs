// Prints the Khronos validator's report on the glTF file given as argument, as JSON.
const fs = require("fs");
const path = require("path");
const [file] = process.argv.slice(2);
// Names come percent-encoded, as they stand in the file.
const beside = (uri) => fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)));
require("gltf-validator")
  .validateBytes(new Uint8Array(fs.readFileSync(file)), {
    externalResourceFunction: (uri) => beside(uri).then((data) => new Uint8Array(data)),
  })
  .then((report) => console.log(JSON.stringify(report.issues)));

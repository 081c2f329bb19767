// Unpacks the page's script and runs it: inline, so that the security policy knows its hash.
const packed = Uint8Array.from(atob(document.getElementById("packed").textContent), (letter) => letter.charCodeAt(0));
const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
new Response(unpacked).text().then((text) => {
  const script = document.createElement("script");
  script.id = "script";
  script.textContent = text;
  document.head.append(script);
});

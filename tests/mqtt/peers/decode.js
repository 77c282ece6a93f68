// Decodes payloads with a library that others wrote (sparkplug-payload): a line of hex each in, a line of JSON each out.
const { get } = require("sparkplug-payload");
const sparkplug = get("spBv1.0");
const lines = require("readline").createInterface({ input: process.stdin });
lines.on("line", (line) => {
  const payload = sparkplug.decodePayload(Buffer.from(line, "hex"));
  const plain = (_, value) => (typeof value === "bigint" || value?.toNumber ? Number(value) : value);
  console.log(JSON.stringify(payload, plain));
});

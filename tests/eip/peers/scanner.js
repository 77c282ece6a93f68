// A scanner that others wrote (st-ethernet-ip): opens a connection to the adapter, sends 48 bytes of 0x5A, and prints
// the first image that comes back turned.
const { IO } = require("st-ethernet-ip");
const [own, adapter] = process.argv.slice(2);
const scanner = new IO.Scanner(2222, own);
const connection = scanner.addConnection(
  {
    configInstance: { assembly: 1, size: 0 },
    inputInstance: { assembly: 100, size: 48 },
    outputInstance: { assembly: 150, size: 48 },
  },
  20,
  adapter,
);
connection.outputData.fill(0x5a);
const wanted = Buffer.alloc(48, 0xa5);
setInterval(() => {
  if (wanted.equals(connection.inputData)) {
    console.log(connection.inputData.toString("hex"));
    process.exit(0);
  }
}, 10);

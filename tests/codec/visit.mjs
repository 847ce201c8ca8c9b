// Reads every golden frame with the package of the codec, then visits a world: prints what was read.
import { readFileSync } from "node:fs";
import { decodeServer, encodeClient, unpackBlock, unpackSteps, WireError } from "esplanade-codec";

const [golden, address] = process.argv.slice(2);

const plain = (message) =>
  message?.block ? { ...message, block: Buffer.from(message.block).toString("hex") } : message;

const read = JSON.parse(readFileSync(golden, "utf8"))
  .filter((row) => row.from === "server")
  .map((row) => plain(decodeServer(Buffer.from(row.frame, "hex"))));

let refused = null;
try {
  unpackSteps(new Uint8Array(2));
} catch (error) {
  refused = error instanceof WireError ? error.message : String(error);
}

const seen = { avatars: 0, steps: 0, numbers: 0 };
let origin = null;
const socket = new WebSocket(address);
socket.binaryType = "arraybuffer";
socket.onopen = () => {
  const nothing = { resume: null, operator: null, admission: null, look: null };
  socket.send(encodeClient({ type: "hello", name: "Ida", ...nothing }));
};
socket.onmessage = ({ data }) => {
  const message = decodeServer(data);
  if (message?.type === "welcome") origin = message.origin;
  if (message?.type === "snapshot") {
    seen.avatars = Math.max(seen.avatars, unpackBlock(message.block, origin).length);
  }
  if (message?.type === "steps") {
    for (const step of unpackSteps(message.block)) {
      seen.steps += 1;
      seen.numbers = step.keys.length;
    }
  }
  if (seen.avatars > 0 && seen.steps > 0) socket.close(1000);
};
socket.onclose = () => console.log(JSON.stringify({ read, refused, seen }));

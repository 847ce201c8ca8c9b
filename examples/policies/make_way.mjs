// The policy of make_way.py in JavaScript, over a socket.
//
//   node examples/policies/make_way.mjs 5555
//   esplanade evaluate crowd.csv --policy tcp://127.0.0.1:5555/MakeWay

import { createServer } from "node:net";
import { createInterface } from "node:readline";

const REACH_M = 2;
const PUSH = 0.6;

function velocity({ position, waypoint, people }, speed) {
  const [x, y] = position;
  const ahead = Math.max(1e-9, Math.hypot(waypoint[0] - x, waypoint[1] - y));
  let vx = (speed * (waypoint[0] - x)) / ahead;
  let vy = (speed * (waypoint[1] - y)) / ahead;
  for (const person of people) {
    const [dx, dy] = [x - person.position[0], y - person.position[1]];
    const distance = Math.max(0.1, Math.hypot(dx, dy));
    if (distance >= REACH_M) continue;
    vx += ((PUSH * dx) / distance) * (REACH_M - distance);
    vy += ((PUSH * dy) / distance) * (REACH_M - distance);
  }
  return [vx, vy];
}

/** Each line is a question, and has one answer. */
function serve(socket) {
  socket.setNoDelay();
  socket.on("error", () => socket.destroy());
  let speed = 1.3;
  createInterface({ input: socket }).on("line", (line) => {
    const { ask, task, observation } = JSON.parse(line);
    if (ask === "reset") speed = task.preferred_speed;
    const answer =
      ask === "velocity"
        ? { velocity: velocity(observation, speed) }
        : ask === "explain"
          ? {}
          : { ready: true };
    socket.write(`${JSON.stringify(answer)}\n`);
  });
}

const server = createServer(serve);
server.listen(Number(process.argv[2] ?? 5555), "127.0.0.1", () => {
  console.log(`listening on ${server.address().port}`);
});

/*
 * The crowd of Detour as a policy of `esplanade evaluate` (docs/policies.md), over a socket:
 *
 *   node benchmarks/recast/policy.mjs 5556
 *   esplanade evaluate crowd.csv --policy tcp://127.0.0.1:5556/detour
 *
 * The robot is an agent of the crowd; people are others, which go on as fast as they do. Ground is
 * the plane of the recording, walls are thin boxes on it. Detour has y up: (x, y) becomes (x, 0, -y).
 */

import { createServer } from "node:net";
import { createInterface } from "node:readline";
import { Crowd, NavMeshQuery, init } from "@recast-navigation/core";
import { generateSoloNavMesh } from "@recast-navigation/generators";

const MARGIN_M = 5;
const WALL_M = 0.05;
const WALL_HIGH_M = 2;
const PERSON = { radius: 0.25, height: 1.8, maxAcceleration: 1000, maxSpeed: 10 };
const MOST_PEOPLE = 128;
/** Of its own demonstration: all of its ways to evade, at the best quality. */
const EVADES = {
  collisionQueryRange: 3,
  pathOptimizationRange: 10,
  separationWeight: 2,
  updateFlags: 31,
  obstacleAvoidanceType: 3,
};

const ground = ([x, y]) => ({ x, y: 0, z: -y });

/** Two triangles over four corners, counter-clockwise as seen from their upper side. */
function quad(mesh, corners) {
  const first = mesh.positions.length / 3;
  for (const corner of corners) mesh.positions.push(...corner);
  for (const k of [0, 1, 2, 0, 2, 3]) mesh.indices.push(first + k);
}

function meshOf({ bounds: [x0, y0, x1, y1], walls }) {
  const mesh = { positions: [], indices: [] };
  const [west, east] = [x0 - MARGIN_M, x1 + MARGIN_M];
  const [north, south] = [-(y1 + MARGIN_M), -(y0 - MARGIN_M)];
  quad(mesh, [
    [west, 0, south],
    [east, 0, south],
    [east, 0, north],
    [west, 0, north],
  ]);
  for (const [a, b] of walls) box(mesh, a, b);
  return mesh;
}

/** A thin wall from one end to the other: its top is too high to step on, its sides stop bodies. */
function box(mesh, [ax, ay], [bx, by]) {
  const long = Math.max(1e-6, Math.hypot(bx - ax, by - ay));
  const [nx, ny] = [(-(by - ay) / long) * WALL_M, ((bx - ax) / long) * WALL_M];
  const feet = [
    [ax + nx, ay + ny],
    [ax - nx, ay - ny],
    [bx - nx, by - ny],
    [bx + nx, by + ny],
  ];
  const at = ([x, y], height) => [x, height, -y];
  quad(
    mesh,
    feet.map((foot) => at(foot, WALL_HIGH_M)),
  );
  for (let k = 0; k < 4; k++) {
    const [from, to] = [feet[k], feet[(k + 1) % 4]];
    quad(mesh, [at(from, 0), at(to, 0), at(to, WALL_HIGH_M), at(from, WALL_HIGH_M)]);
  }
}

/** One trip of the robot. */
class Trip {
  constructor(task, navMesh) {
    this.task = task;
    this.crowd = new Crowd(navMesh, { maxAgents: MOST_PEOPLE + 1, maxAgentRadius: 0.6 });
    const query = new NavMeshQuery(navMesh);
    const on = (place) => query.findClosestPoint(ground(place)).point;
    this.robot = this.crowd.addAgent(on(task.start), {
      radius: task.radius,
      height: 1.8,
      maxAcceleration: task.greatest_acceleration ?? 100,
      maxSpeed: task.preferred_speed,
      ...EVADES,
    });
    this.robot.requestMoveTarget(on(task.goal));
    this.people = new Map();
  }

  velocity({ position, velocity, people }) {
    put(this.robot, position, velocity);
    const seen = new Set();
    for (const person of people.slice(0, MOST_PEOPLE)) {
      seen.add(person.id);
      let agent = this.people.get(person.id);
      if (agent === undefined) {
        const params = { ...PERSON, radius: person.radius, updateFlags: 0 };
        agent = this.crowd.addAgent(ground(person.position), params);
        this.people.set(person.id, agent);
      }
      put(agent, person.position, person.velocity);
      const [vx, vy] = person.velocity;
      agent.requestMoveVelocity({ x: vx, y: 0, z: -vy });
    }
    for (const [id, agent] of this.people) {
      if (seen.has(id)) continue;
      this.crowd.removeAgent(agent);
      this.people.delete(id);
    }
    this.crowd.update(this.task.tick_s);
    const { x, z } = this.robot.velocity();
    return [x, -z];
  }
}

/** An agent is where it is said to be, and moves as it is said to. */
function put(agent, [x, y], [vx, vy]) {
  agent.raw.set_npos(0, x);
  agent.raw.set_npos(2, -y);
  [vx, 0, -vy].forEach((speed, axis) => agent.raw.set_vel(axis, speed));
}

function serve(socket) {
  socket.setNoDelay();
  socket.on("error", () => socket.destroy());
  const meshes = new Map();
  let trip;

  const navMesh = (task) => {
    const key = JSON.stringify([task.bounds, task.walls, task.radius]);
    if (!meshes.has(key)) {
      const { positions, indices } = meshOf(task);
      const built = generateSoloNavMesh(positions, indices, {
        cs: 0.1,
        ch: 0.05,
        walkableSlopeAngle: 45,
        walkableRadius: Math.ceil(task.radius / 0.1 - 1e-6),
        walkableHeight: 36,
        walkableClimb: 4,
        maxEdgeLen: 120,
        minRegionArea: 10,
      });
      if (!built.success) throw new Error(built.error);
      meshes.clear();
      meshes.set(key, built.navMesh);
    }
    return meshes.get(key);
  };

  const answered = ({ ask, task, observation }) => {
    if (ask === "velocity") return { velocity: trip.velocity(observation) };
    if (ask === "reset") {
      trip?.crowd.destroy();
      trip = new Trip(task, navMesh(task));
    }
    return ask === "explain" ? {} : { ready: true };
  };

  createInterface({ input: socket }).on("line", (line) => {
    let answer;
    try {
      answer = answered(JSON.parse(line));
    } catch (error) {
      answer = { error: error.message };
    }
    socket.write(`${JSON.stringify(answer)}\n`);
  });
}

await init();
const server = createServer(serve);
server.listen(Number(process.argv[2] ?? 5556), "127.0.0.1", () => {
  console.log(`listening on ${server.address().port}`);
});

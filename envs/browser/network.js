// A trained agent: the network is a kernel, and its operations and weights are a small file.

/**
 * What a network says of what it sees.
 * @typedef {object} Judgement
 * @property {number | [number, number]} action the likeliest, for `Game.step`
 * @property {Float64Array} probabilities of each action; of use until memory is reserved. Empty
 *   where actions are velocities
 * @property {number} value the rewards that it expects, discounted
 */

/** An agent that sees a game. */
export class Agent {
  /**
   * @param {Game} game which it sees, and in whose memory it lives
   * @param {ArrayBuffer | Uint8Array} file of the network
   */
  constructor(game, file) {
    const bytes = file instanceof Uint8Array ? file : new Uint8Array(file);
    const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
    if (!fits(header, game)) {
      throw new RangeError(`${header.name} was not trained in a game like ${game.name}`);
    }
    this.game = game;
    this.name = header.name;
    this.config = header.config;
    this.discrete = header.discrete;
    this.sees = header.sees;
    this.record = this._lay(header, bytes.subarray(4 + length));
    this._whole = false;
  }

  /** @returns {Judgement} what the agent says of the game as it is */
  judge() {
    this._look();
    const { record } = this;
    const { machine } = this.game;
    machine.kernels.judge(0, record.$address);
    const { value, num_outputs: count } = record;
    if (this.discrete) {
      const probabilities = machine.array("f8", record.probabilities, count);
      return { action: record.action, value, probabilities };
    }
    const means = machine.array("f4", record.weights + 4 * record.outputs, count);
    return { action: Array.from(means), value, probabilities: new Float64Array() };
  }

  /** @returns {Uint8Array} the pictures that it has seen last, the oldest first; null: none */
  get pictures() {
    const { kind, inputs } = this.sees;
    return kind === "rgb" ? this.game.machine.bytes(this.record.observation, inputs) : null;
  }

  /** Lay out the network in memory, and return its record. */
  _lay(header, content) {
    const { machine } = this.game;
    const { sees, computed, operations } = header;
    const record = machine.record("Network");
    const size = operations * machine.manifest.records.Operation.length;
    const weights = content.subarray(size);
    const put = (array) => {
      const address = machine.reserve(array.length);
      machine.bytes(address, array.length).set(array);
      return address;
    };
    record.operations = put(content.subarray(0, size));
    record.num_operations = operations;
    // Numbers that are computed lie before the weights.
    machine.reserve(4 * computed);
    record.weights = put(weights);
    record.inputs = sees.inputs;
    record.pictures = sees.pictures ?? 0;
    record.channels = sees.channels ?? 0;
    const shown = sees.kind === "rgb";
    record.observation = shown ? machine.reserve(sees.inputs) : this.game.address(sees.kind);
    [record.outputs, record.num_outputs] = header.outputs;
    record.probabilities = machine.reserve(8 * record.num_outputs);
    record.worth = header.value;
    return record;
  }

  _look() {
    if (this.sees.kind === "rgb") this._take();
    else this.game[this.sees.kind]();
  }

  /** Take a picture. The first one of an episode takes all places of the stack. */
  _take() {
    const { world, config } = this.game;
    const { size: [height, width], channels, pictures } = this.sees;
    const drawn = this.game.draw(width, height, channels);
    const stack = this.pictures;
    const { length } = drawn;
    const played = world.decisions - world.first_decision;
    if (played === 0) {
      for (let place = 0; place < pictures; place += 1) stack.set(drawn, place * length);
    } else {
      // A picture between two of the agent's decisions stays only until the next one.
      if (this._whole && played !== this._taken) stack.copyWithin(0, length);
      stack.set(drawn, stack.length - length);
    }
    this._taken = played;
    this._whole = (played * config.frame_skip) % this.config.frame_skip === 0;
  }
}

/** Return whether a network can see a game, and act in it. */
function fits({ sees, discrete, outputs }, game) {
  const count = game.commands ? game.commands.length : null;
  if (count !== (discrete ? outputs[1] : null)) return false;
  if (sees.kind === "rgb") return true;
  return game.shapes[sees.kind]?.reduce((one, other) => one * other, 1) === sees.inputs;
}

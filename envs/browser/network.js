// A trained agent: the network is a kernel, and its weights are a small file.

/**
 * What a network says of what it sees.
 * @typedef {object} Judgement
 * @property {number} action the likeliest
 * @property {Float64Array} probabilities of each action; of use until memory is reserved
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
    const { machine } = game;
    const { widths } = header;
    const [inputs] = widths;
    if (inputs !== game.shapes.vector[0] || widths.at(-1) !== game.commands?.length) {
      throw new RangeError(`${header.name} was not trained in a game like ${game.name}`);
    }
    this.game = game;
    this.name = header.name;
    this.config = header.config;
    const weights = bytes.subarray(4 + length);
    const record = machine.record("Network");
    const widest = Math.max(...widths);
    record.observation = game.address("vector");
    record.weights = machine.reserve(weights.length);
    machine.bytes(record.weights, weights.length).set(weights);
    record.scratch = machine.reserve(2 * 4 * widest);
    record.outputs = machine.reserve(4 * widths.at(-1));
    record.probabilities = machine.reserve(8 * widths.at(-1));
    record.layers = widths.length - 1;
    record.widths = widths.map(BigInt);
    record.activation = machine.manifest.activations[header.activation];
    this.record = record;
  }

  /** @returns {Judgement} what the agent says of the game as it is */
  judge() {
    this.game.vector();
    const { machine } = this.game;
    const { record } = this;
    machine.kernels.judge(0, record.$address);
    const { action, value } = record;
    const count = this.game.commands.length;
    return { action, value, probabilities: machine.array("f8", record.probabilities, count) };
  }
}

// The last `size` values that were pushed, oldest first.
export class Ring {
  constructor(size) { this.size = size; this.clear(); }
  clear() { this.values = []; this.next = 0; }
  push(value) {
    this.values[this.next] = value;
    this.next = (this.next + 1) % this.size;
  }
  get last() { return this.values.at(this.next - 1); }
  *[Symbol.iterator]() {
    const { length } = this.values;
    const first = length < this.size ? 0 : this.next;
    for (let i = 0; i < length; ++i) yield this.values[(first + i) % length];
  }
}

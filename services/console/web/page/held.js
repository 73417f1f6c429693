// What became of something that was measured, in words, and the way by keyboard through what was left out.
const short = value => Number(value.toPrecision(3));

// How far off it was, and what that was held against: the most, or for a gap between two edges the least that it may be.
const heldAgainst = ({ accepted, off, limit, off_unit }) => Number.isFinite(off) && Number.isFinite(limit)
  ? `, ${short(off)} ${off_unit}, ${accepted === false && Math.abs(off) < limit ? 'at least' : 'limit'} ${short(limit)}` : '';

// The pass rejects; what it accepts the filter may still leave out, by its innovation.
export const isRejected = ({ accepted }) => accepted === false;
export const isLeftOut = one => isRejected(one) || one.used === false;

export const whatBecameOf = (one, taken = 'accepted') => (isRejected(one) ? `rejected: ${one.rejected_by ?? 'no reason given'}`
  : isLeftOut(one) ? `${taken}, left out by sequential: innovation` : taken) + heldAgainst(one);

const isSame = (a, b) => a.t_tai_ns === b?.t_tai_ns && a.name === b.name && a.channel === b.channel;

// The arrow keys go through what was left out: the one of `all` beside `told`, which may be of an earlier answer.
export function nextLeftOut(event, all, told) {
  const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  const leftOut = all.filter(isLeftOut);
  if (!step || !leftOut.length) return undefined;
  event.preventDefault();
  const at = leftOut.findIndex(one => isSame(one, told));
  return leftOut.at(at < 0 ? Math.min(step, 0) : (at + step) % leftOut.length);
}

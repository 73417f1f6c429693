// How far off something was, and what that was held against.
const short = value => Number(value.toPrecision(3));

export const heldAgainst = ({ off, limit, off_unit }) => Number.isFinite(off) && Number.isFinite(limit)
  ? `, ${short(off)} ${off_unit}, limit ${short(limit)}` : '';

import assert from 'node:assert/strict';
import test from 'node:test';
import { isLeftOut, nextLeftOut, whatBecameOf } from '../../services/console/web/page/held.js';

const taken = { t_tai_ns: 1, channel: 'sun1', accepted: true, used: true, off: 0.51234, limit: 5, off_unit: 'sigma' };
const leftOut = { ...taken, t_tai_ns: 2, used: false, off: -6.1 };
const spoilt = { ...taken, t_tai_ns: 4, accepted: false, used: null, rejected_by: 'interference', off: 3e-4, limit: 1e-3, off_unit: 's' };
const rejected = { ...taken, t_tai_ns: 3, accepted: false, used: null, rejected_by: 'period', off: 8, off_unit: 's' };

test('says what the pass and what the filter decided', () => {
  assert.equal(whatBecameOf(taken), 'accepted, 0.512 sigma, limit 5');
  assert.equal(whatBecameOf(leftOut), 'accepted, left out by sequential: innovation, -6.1 sigma, limit 5');
  assert.equal(whatBecameOf(rejected), 'rejected: period, 8 s, limit 5');
  assert.equal(whatBecameOf(spoilt), 'rejected: interference, 0.0003 s, at least 0.001');
  assert.equal(whatBecameOf({ accepted: true }, 'used'), 'used');
  assert.deepEqual([taken, leftOut, rejected].map(isLeftOut), [false, true, true]);
});

test('goes by arrow keys through all that was left out, and on in a later answer', () => {
  const all = [taken, leftOut, rejected];
  const after = (key, told, of = all) => nextLeftOut({ key, preventDefault() {} }, of, told);
  assert.equal(after('ArrowRight'), leftOut);
  assert.equal(after('ArrowLeft'), rejected);
  assert.equal(after('ArrowRight', leftOut), rejected);
  assert.equal(after('ArrowRight', rejected), leftOut);
  assert.equal(after('ArrowLeft', leftOut), rejected);
  assert.equal(after('ArrowRight', leftOut, structuredClone(all)).rejected_by, 'period');
  assert.equal(after('Tab', leftOut), undefined);
  assert.equal(after('ArrowRight', undefined, [taken]), undefined);
});

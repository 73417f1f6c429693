// The service and what sends to it, as other processes.
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const program = process.env.SPINDRIFT;
const root = resolve(fileURLToPath(new URL('.', import.meta.url)), '../..');
const environment = { ...process.env, CYCLONEDDS_URI: `file://${join(root, 'deploy/cyclonedds/loopback.xml')}` };

// Domain N has the 250 UDP ports from 7400 + 250 N on.
function unusedDomain() {
  const used = new Set();
  for (const table of ['/proc/net/udp', '/proc/net/udp6'].filter(existsSync)) {
    for (const row of readFileSync(table, 'utf8').trim().split('\n').slice(1)) {
      const port = parseInt(row.trim().split(/\s+/)[1].split(':').at(-1), 16);
      used.add(Math.floor((port - 7400) / 250));
    }
  }
  for (let domain = 60; domain < 100; ++domain) if (!used.has(domain)) return domain;
  throw new Error('every DDS domain from 60 to 99 is in use');
}

// `pass`: a folder of tests/data.
export class Service {
  constructor(pass) {
    this.pass = join(root, 'tests/data', pass);
    this.mission = join(this.pass, 'mission.toml');
    this.folder = mkdtempSync(join(tmpdir(), 'spindrift-browser-'));
    this.archive = join(this.folder, 'pass.db');
    this.bus = ['--domain', `${unusedDomain()}`, '--partition', 'replay'];
  }

  // Resolves when it is ready, with `url` known.
  async start(address = '127.0.0.1:0') {
    this.process = spawn(program, ['serve', '--mission', this.mission, '--db', this.archive, ...this.bus, '--console', address],
      { env: environment, stdio: ['ignore', 'pipe', 'pipe'] });
    let said = '';
    await new Promise((ready, failed) => {
      const hear = text => {
        said += text;
        if (/ready\s*$/m.test(said)) ready();
      };
      this.process.stdout.on('data', hear);
      this.process.stderr.on('data', hear);
      this.process.once('exit', status => failed(new Error(`the service ended with ${status}: ${said}`)));
    });
    this.url = said.match(/http:\/\/127\.0\.0\.1:\d+\//)?.[0];
    if (!this.url) throw new Error(`the service told no address: ${said}`);
  }

  async replay() {
    const sender = spawn(program, ['replay', '--mission', this.mission, '--telemetry', this.pass, ...this.bus, '--speed', '60'],
      { env: environment, stdio: 'ignore' });
    const [status] = await once(sender, 'exit');
    if (status !== 0) throw new Error(`replay ended with ${status}`);
  }

  signal(name) { this.process.kill(name); }

  async stop() {
    if (this.process.exitCode !== null) return this.process.exitCode;
    this.signal('SIGCONT');
    this.signal('SIGTERM');
    const [status] = await once(this.process, 'exit');
    return status;
  }

  // The one row of `sql`.
  row(sql) {
    return JSON.parse(execFileSync('sqlite3', ['-readonly', '-json', this.archive, sql], { encoding: 'utf8' }) || '[]')[0];
  }

  token() { return readFileSync(`${this.archive}.token`, 'utf8').trim(); }

  remove() { rmSync(this.folder, { recursive: true }); }
}

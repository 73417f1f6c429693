// The canvas's context in CSS pixels, cleared, with its width and height.
export function begin(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const scale = devicePixelRatio;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const pen = canvas.getContext('2d');
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = '13px "DejaVu Sans", sans-serif';
  pen.lineWidth = 1;
  return { pen, width, height };
}

export const colours = { text: '#e3e6e8', dim: '#a4b0b9', line: '#38434d', good: '#6fd08c', bad: '#ff8a75', warn: '#f2b134',
  mark: '#7cb9f2' };

export function cross(pen, x, y, half) {
  pen.beginPath();
  pen.moveTo(x - half, y - half);
  pen.lineTo(x + half, y + half);
  pen.moveTo(x - half, y + half);
  pen.lineTo(x + half, y - half);
  pen.stroke();
}

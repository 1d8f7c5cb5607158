// @vitest-environment happy-dom
// How often what was heard is put on the screen: at once when nothing was put lately, never faster than the pause, never lost, once each.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { beforeNextPicture, overviewPeriod, pauseOf } from '../src/gateway';

describe('beforeNextPicture', () => {
  let pictures = 0;
  beforeEach(() => {
    vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout', 'performance', 'Date'] });
    // A screen of 60 Hz on the same clock.
    vi.stubGlobal('requestAnimationFrame', (f: () => void) => setTimeout(f, 1000 / 60 - (performance.now() % (1000 / 60))));
    vi.advanceTimersByTime(10_000);
    pictures = 0;
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });
  const put = () => (pictures += 1);

  it('puts what comes at 20 Hz with the very next picture', () => {
    for (let i = 0; i < 20; i += 1) {
      beforeNextPicture(put);
      vi.advanceTimersByTime(17);
      expect(pictures).toBe(i + 1);
      vi.advanceTimersByTime(33);
    }
  });

  it('puts many axes on the screen as often as they are told, and no oftener; an axis that is looked at closely is not held back', () => {
    expect([pauseOf(32, 0), pauseOf(33, 0), pauseOf(64, 1)]).toEqual([40, 190, 40]);
    expect([overviewPeriod(32), overviewPeriod(33)]).toEqual([100, 200]);
    vi.advanceTimersByTime(10_000);
    // Told five times a second, they are put with the very next picture each time.
    for (let i = 0; i < 20; i += 1) {
      beforeNextPicture(put, pauseOf(64, 0));
      vi.advanceTimersByTime(17);
      expect(pictures).toBe(i + 1);
      vi.advanceTimersByTime(183);
    }
    // What is told between two of these waits for the next one.
    beforeNextPicture(put, pauseOf(64, 0));
    vi.advanceTimersByTime(100);
    beforeNextPicture(put, pauseOf(64, 0));
    vi.advanceTimersByTime(83);
    expect(pictures).toBe(21);
    vi.advanceTimersByTime(34);
    expect(pictures).toBe(22);
  });

  it('puts what comes faster at most 25 times a second, and the last of it too', () => {
    let waits = false;
    for (let ms = 0; ms < 1000; ms += 1) {
      if (!waits) {
        waits = true;
        beforeNextPicture(() => {
          waits = false;
          put();
        });
      }
      vi.advanceTimersByTime(1);
    }
    expect(pictures).toBeGreaterThanOrEqual(15);
    expect(pictures).toBeLessThanOrEqual(25);
    vi.advanceTimersByTime(100);
    expect(waits).toBe(false);
  });

  it('takes in what a hidden page hears, though no picture is drawn', () => {
    vi.stubGlobal('requestAnimationFrame', () => 0);
    beforeNextPicture(put);
    vi.advanceTimersByTime(249);
    expect(pictures).toBe(0);
    vi.advanceTimersByTime(2);
    expect(pictures).toBe(1);
    vi.advanceTimersByTime(1000);
    expect(pictures).toBe(1);
  });
});

// Jog button: the axis moves while it is held, by finger, mouse or key, and stops when it is let go, when the pointer slides off it or is lost,
// when the page is hidden, closed or loses the keyboard. Never starts by a click alone that was not held.
import { t } from '../language';
import { useEffect, useRef } from 'preact/hooks';
import { useGateway } from '../gateway';
import { useBarred } from './gate';
import { Icon } from './icon';

export interface JogProps {
  axis: string;
  direction: 1 | -1;
  /** The speed asked for, in the axis' unit per second, or null after the caller has said why not. */
  speed: () => number | null;
  unit: string;
}

/** A finger is not still: so far around the button it is still held. Back on it does not begin anew. */
const margin_px = 12;

export function JogButton({ axis, direction, speed, unit }: JogProps) {
  const gateway = useGateway();
  const button = useRef<HTMLButtonElement>(null);
  const jog = gateway.jog(axis);

  // The two buttons of an axis share its jog: each ends only what it began.
  const holding = useRef(false);
  const pointer = useRef<number | null>(null);
  const no = useBarred('operator');

  const press = () => {
    if (no.disabled) return; // some browsers tell a disabled button of pointers too
    const v = speed();
    if (v === null) return;
    holding.current = true;
    button.current?.classList.add('is-held');
    jog.press(direction * v, t('Jog {speed} {unit}/s', { speed: `${direction > 0 ? '+' : '−'}${v}`, unit }));
  };
  const release = () => {
    if (!holding.current) return;
    holding.current = false;
    pointer.current = null;
    button.current?.classList.remove('is-held');
    jog.release();
  };

  useEffect(() => {
    const whenHidden = () => {
      if (document.hidden) release();
    };
    addEventListener('blur', release);
    addEventListener('pagehide', release);
    document.addEventListener('visibilitychange', whenHidden);
    return () => {
      removeEventListener('blur', release);
      removeEventListener('pagehide', release);
      document.removeEventListener('visibilitychange', whenHidden);
      release();
    };
  }, [jog]);

  const isKey = (e: KeyboardEvent) => e.key === ' ' || e.key === 'Enter';
  return (
    <button
      ref={button}
      type="button"
      class="button jog"
      aria-label={direction > 0 ? t('Jog {axis} forward while held', { axis }) : t('Jog {axis} backward while held', { axis })}
      title={t('Moves while held')}
      {...no}
      onPointerDown={(e) => {
        if (e.button !== 0) return;
        e.currentTarget.setPointerCapture?.(e.pointerId);
        press();
        if (holding.current) pointer.current = e.pointerId;
      }}
      onPointerMove={(e) => {
        if (pointer.current !== e.pointerId) return; // held by a key, or by another finger
        const r = e.currentTarget.getBoundingClientRect();
        if (e.clientX < r.left - margin_px || e.clientX > r.right + margin_px || e.clientY < r.top - margin_px || e.clientY > r.bottom + margin_px) release();
      }}
      onPointerUp={release}
      onPointerCancel={release}
      onLostPointerCapture={release}
      onContextMenu={(e) => e.preventDefault()}
      onKeyDown={(e) => {
        if (!isKey(e)) return;
        e.preventDefault();
        if (!e.repeat) press();
      }}
      onKeyUp={(e) => {
        if (isKey(e)) release();
      }}
      onBlur={release}
    >
      {direction < 0 && <Icon name="arrow-left" size={14} />}
      <span>{t('Jog')}</span>
      {direction > 0 && <Icon name="arrow-right" size={14} />}
    </button>
  );
}

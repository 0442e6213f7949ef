MODULE M
  VAR bool b;
  PROC main()
    FOR i FROM 1 TO 4 DO
      IF i=1 THEN
        Set do1;
      ELSEIF i=2 THEN
        Set do2;
      ELSEIF i=3 THEN
        IF b THEN
          Set do3;
        ELSE
          Reset do3;
        ENDIF
      ELSE
        Set do4;
      ENDIF
    ENDFOR
    IF b Set do9;
    IF NOT b Set do10;
    IF b THEN
    ENDIF
    Set do11;
  ENDPROC
ENDMODULE

MODULE M
  VAR num n;
  PROC main()
    FOR i FROM 1 TO 3 DO
      WaitTime i;
    ENDFOR
    FOR i FROM 3 TO 1 DO
      WaitTime i;
    ENDFOR
    FOR i FROM 10 TO 0 STEP -5 DO
      WaitTime i;
    ENDFOR
    FOR i FROM 1 TO 2 STEP 0.5 DO
      WaitTime i;
    ENDFOR
    FOR i FROM 5 TO 1 STEP 1 DO
      WaitTime 99;
    ENDFOR
    n:=2;
    FOR i FROM 4 TO n DO
      n:=0;
      WaitTime i;
    ENDFOR
    FOR i FROM n TO 2 DO
      WaitTime i;
    ENDFOR
    n:=-2;
    FOR i FROM 5 TO 1 STEP n DO
      FOR k FROM i TO i+1 DO
        WaitTime 10*i+k;
      ENDFOR
    ENDFOR
  ENDPROC
ENDMODULE

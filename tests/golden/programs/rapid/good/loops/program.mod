MODULE M
  VAR num n:=0;
  PROC main()
    WHILE n<3 DO
      n:=n+1;
      WaitTime n;
    ENDWHILE
    WHILE TRUE DO
      n:=n-1;
      IF n<0 THEN
        EXIT;
      ENDIF
    ENDWHILE
    Set do1;
  ENDPROC
ENDMODULE
